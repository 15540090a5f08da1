# SPDX-License-Identifier: MIT
"""A path in space is projected onto the plane that was asked for, without mirroring."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from model.errors import DomainError
from model.rigid_path import RigidPath, rotations_of_quaternions
from support.foreign_trajectories import drive

# Columns: where a frame's x, y and z point in the frame of the floor.
FRAMES = {
    "xz": [[0, 0, 1], [-1, 0, 0], [0, -1, 0]],  # a camera: x right, y down, z forward
    "zx": [[0, 0, 1], [1, 0, 0], [0, 1, 0]],  # motion capture: y up, x left, z forward
    "yz": [[0, 1, 0], [0, 0, 1], [1, 0, 0]],  # x up
}


@pytest.mark.parametrize("plane", FRAMES)
def test_a_left_turn_stays_a_left_turn_in_every_frame_seen_from_above(plane):
    t, position, rotation = drive()
    axes = np.array(FRAMES[plane], dtype=float)
    seen = RigidPath(t, position @ axes, axes.T @ rotation.as_matrix() @ axes)
    flat = RigidPath(t, position, rotation.as_matrix()).in_plane("xy", forward="x")
    forward = "xyz"[int(np.argmax(axes[0]))]
    found = seen.in_plane(plane, forward=forward)
    turn = found.yaw - flat.yaw
    assert np.ptp(turn) < 1e-9
    again = found.moved(rotation=-float(turn[0]), translation=[0, 0])
    np.testing.assert_allclose(again.position, flat.position, atol=1e-9)


def test_quaternions_give_the_rotations_of_scipy():
    q = np.random.default_rng(1).normal(size=(20, 4))
    np.testing.assert_allclose(
        rotations_of_quaternions(q), Rotation.from_quat(q).as_matrix(), atol=1e-12
    )


@pytest.mark.parametrize("plane", ["xx", "x", "xw", "xyz"])
def test_a_plane_is_two_different_axes(plane):
    path = RigidPath(np.arange(2.0), np.zeros((2, 3)))
    with pytest.raises(DomainError, match="two different axes"):
        path.in_plane(plane, forward="x")
