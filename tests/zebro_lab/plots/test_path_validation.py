# SPDX-License-Identifier: MIT
"""Predicted paths stand beside the track, and their errors over time have units and signs."""

import numpy as np
import pytest

from model.poses import Poses
from zebro_lab.plots.path_validation import path_band, path_validation, tilt

T = np.linspace(0.0, 2.0, 21)
SHIFTS = np.linspace(-1.0, 1.0, 101)


@pytest.fixture
def draws() -> Poses:
    """Return 101 draws of a path along x, evenly to the left and right of it."""
    position = np.zeros((len(SHIFTS), len(T), 2))
    position[..., 0], position[..., 1] = T, SHIFTS[:, None] * T
    return Poses(T, position, np.radians(10.0) * SHIFTS[:, None] * T)


def test_bands_hold_half_and_nine_tenths_of_the_draws(draws):
    figure = path_band(draws, title="A walk")
    assert figure.get_suptitle() == "A walk (simulated)"
    above, x, y, yaw = figure.axes
    assert len(above.lines) == 60 + 1
    np.testing.assert_allclose(above.lines[-1].get_xydata(), np.column_stack([T, 0 * T]), atol=1e-9)
    for axes, end in ((y, 2.0), (yaw, 20.0)):
        reach = [band.get_paths()[0].get_extents().ymax for band in axes.collections]
        assert reach == pytest.approx([0.9 * end, 0.5 * end])
    np.testing.assert_allclose(x.lines[0].get_xydata(), np.column_stack([T, T]))
    labels = [axes.get_ylabel() for axes in (above, x, y, yaw)]
    assert labels == ["y [m]", "x [m]", "y [m]", "yaw [deg]"]
    assert yaw.get_xlabel() == "time [s]"


TRACK = Poses(T, np.column_stack([T, 0 * T]), 0 * T)


def moved(x: float, y: float, yaw: float) -> Poses:
    return Poses(T, TRACK.position + np.array([x, y]), TRACK.yaw + yaw)


def test_errors_over_a_metre_are_in_metres_and_poses_may_have_no_times():
    how = {"of": "Estimate and reference", "plane": "xz", "timed": False}
    paths = {"slam": moved(2.0, 0.0, 0.0)}
    figure = path_validation(paths, TRACK, band=None, title="a", simulated=False, **how)
    above, along, *_, yaw = figure.axes
    np.testing.assert_allclose(along.lines[0].get_ydata(), 2.0)
    assert (above.get_ylabel(), along.get_ylabel()) == ("z [m]", "ahead [m]")
    assert yaw.get_xlabel() == "number of the pose"


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


@pytest.mark.parametrize(("duration", "shown"), [(20.0, (7.0, 13.0)), (4.0, (0.0, 4.0))])
def test_measured_and_predicted_angles_are_drawn_over_the_middle(duration, shown):
    t = np.linspace(0.0, duration, 201)
    predicted = np.column_stack([0.1 * np.sin(t), 0.2 * np.cos(t)])
    measured = predicted + 0.01
    figure = tilt(t, predicted, measured, title="w", simulated=True)
    assert len(figure.axes) == 2
    for axes, said, seen in zip(figure.axes, predicted.T, measured.T, strict=True):
        lines = {line.get_label(): line for line in axes.lines}
        assert set(lines) == {"IMU", "predicted"}
        for name, angle in (("IMU", seen), ("predicted", said)):
            at, value = lines[name].get_data()
            assert (at[0], at[-1]) == pytest.approx(shown)
            np.testing.assert_allclose(value, np.degrees(np.interp(at, t, angle)))
        assert "[deg]" in axes.get_ylabel()
    assert ("the middle 6 s" in figure.axes[1].get_xlabel()) == (duration > 6)
    assert "(simulated)" in figure.get_suptitle()
