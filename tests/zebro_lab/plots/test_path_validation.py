# SPDX-License-Identifier: MIT
"""Predicted paths stand beside the track, and their errors over time have units and signs."""

import numpy as np

from model.poses import Poses
from zebro_lab.plots.path_validation import path_validation

T = np.linspace(0.0, 4.0, 9)
TRACK = Poses(T, np.column_stack([T, 0 * T]), 0 * T)


def moved(x: float, y: float, yaw: float) -> Poses:
    return Poses(T, TRACK.position + np.array([x, y]), TRACK.yaw + yaw)


def test_errors_are_along_across_and_of_yaw_in_millimetres_and_degrees():
    paths = {"prediction": moved(0.01, -0.02, 0.1), "no-slip": moved(0.0, 0.0, 0.0)}
    figure = path_validation(paths, TRACK, band=None, title="w", simulated=True)
    above, along, cross, yaw = figure.axes
    for axes, value in ((along, 10.0), (cross, -20.0), (yaw, np.degrees(0.1))):
        prediction, no_slip = axes.lines[:2]
        np.testing.assert_allclose(prediction.get_xydata(), np.column_stack([T, value + 0 * T]))
        np.testing.assert_allclose(no_slip.get_ydata(), 0.0, atol=1e-9)
    assert [line.get_label() for line in above.lines] == ["prediction", "no-slip", "track"]
    np.testing.assert_array_equal(above.lines[-1].get_xydata(), TRACK.position)
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["y [m]", "ahead [mm]", "to the left [mm]", "yaw [deg]"]
    assert figure.get_suptitle() == "Prediction and track: w (simulated)"
