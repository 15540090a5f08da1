# SPDX-License-Identifier: MIT
"""A robot's picture is solved from its sum over a walk."""

import cv2
import numpy as np

from support.drawn_board import SIZE, level_plane
from tracking.composite.body_raster import BodyRaster
from tracking.composite.steps import steady_chain
from tracking.composite.superposition import solve_robot, superposed


def test_a_robot_is_solved_from_a_sum_of_itself():
    body, rng = BodyRaster.over(level_plane(), SIZE, margin=4), np.random.default_rng(2)
    own = cv2.GaussianBlur(rng.normal(0, 60, (*body.x.shape, 3)).astype(np.float32), (0, 0), 2)
    poses = steady_chain(np.array([-0.25, 0.0, 0.0]), np.array([0.1, 0.0, 0.1]), 0.0, 4, 0)
    change = superposed(body, poses, own)
    seen = np.mean([body.read(change, pose) for pose in poses], axis=0)
    solved = solve_robot(body, poses, change)
    assert np.corrcoef(solved.ravel(), own.ravel())[0, 1] > 0.97
    assert np.corrcoef(seen.ravel(), own.ravel())[0, 1] < 0.9  # what many others would take
