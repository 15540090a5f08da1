# SPDX-License-Identifier: MIT
"""A bumped tripod begins a new stand of the camera."""

import numpy as np
import pytest

from support.drawn_floor import FLOOR, LENS, camera_pose, see
from tracking.floor import refine_floor, split_stands


@pytest.mark.parametrize("degrees", [0.05, 0.3])
def test_a_bumped_tripod_is_noticed_where_it_happens(degrees):
    rng = np.random.default_rng(4)
    poses = [camera_pose()] * 6 + [camera_pose(pan=np.radians(degrees))] * 5
    views = [see(FLOOR, pose, rng, f"p{index}.jpg") for index, pose in enumerate(poses)]
    assert split_stands(views) == (0,) * 6 + (1,) * 5
    fit = refine_floor(LENS, FLOOR, views)
    assert "moved between p5.jpg and p6.jpg" in fit.warnings[0]
    turn = fit.pose_of("p0.jpg").rotation @ fit.pose_of("p10.jpg").rotation.T
    angle = np.degrees(np.arccos((np.trace(turn) - 1) / 2))
    assert angle == pytest.approx(degrees, rel=0.1)


def test_a_camera_at_rest_is_one_stand():
    rng = np.random.default_rng(5)
    views = [see(FLOOR, camera_pose(), rng, f"p{index}.jpg") for index in range(60)]
    assert set(split_stands(views)) == {0}
