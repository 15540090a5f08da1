# SPDX-License-Identifier: MIT
"""Legs at touchdown and lift-off, from the side."""

import numpy as np
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from support.figure_extents import overhang
from zebro_lab.plots.walk_stance import stances


@pytest.mark.parametrize("arc_deg", [180.0, 200.0])
def test_legs_stand_on_the_ground_with_matched_hips(arc_deg):
    robot = Robot(leg_arc=np.radians(arc_deg))
    angles = tripod_angles(np.radians(50.0), 1.1, leg_arc=robot.leg_arc)
    figure = stances(tripod_reference(angles, 2.0), robot, title="A gait")
    assert overhang(figure) <= 0
    for axes, inner in zip(figure.axes, (True, False), strict=True):
        assert ("inner" in axes.get_title(loc="left")) == inner
        legs = [line for line in axes.lines if len(line.get_xdata()) > 2]
        assert len(legs) == 2
        for leg in legs:
            assert np.min(leg.get_ydata()) == pytest.approx(0.0, abs=3e-4)  # of 25 points
        heights = [text.get_text().splitlines()[1] for text in axes.texts]
        assert heights[0] == heights[1]
    assert figure.axes[0].texts[0].get_text().startswith("50.0°")
