# SPDX-License-Identifier: MIT
"""A tracked walk has a pose to start from and two to compare."""

import numpy as np
import pytest

from model.errors import InsufficientData
from model.gait.reference import SampledReference
from model.joint_covariance import JointCovariance
from model.walk_fit.tracked_walk import FEWEST_POSES, TrackedWalk, middle

LEGS = SampledReference(np.array([0.0, 0.5, 1.0]), np.zeros((3, 6)))


def walk(n):
    joint = JointCovariance.independent(np.tile(1e-6 * np.eye(3), (n, 1, 1)))
    return TrackedWalk("w", LEGS, np.arange(float(n)), np.zeros((n, 3)), joint)


def test_fewer_poses_than_can_be_compared_are_refused():
    assert len(walk(FEWEST_POSES).t) == FEWEST_POSES
    with pytest.raises(InsufficientData, match="walk 'w' has 2 tracked poses"):
        walk(FEWEST_POSES - 1)


def test_exact_leg_angles_are_their_own_middle():
    assert middle(LEGS) is LEGS
