# SPDX-License-Identifier: MIT
"""Roll and pitch are drawn in degrees, some seconds in the middle of the walk."""

import numpy as np
import pytest

from zebro_lab.plots.tilt import tilt


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
    roll, pitch = figure.axes
    assert roll.get_ylabel() == "roll [deg]\n(left side up)"
    part = ", the middle 6 s of the walk" if duration > 6 else ""
    assert pitch.get_ylabel() == "pitch [deg]\n(nose down)"
    assert pitch.get_xlabel() == f"time [s]{part}"
    assert figure.get_suptitle() == "Roll and pitch: w (simulated)"
