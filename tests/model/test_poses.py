# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError, InsufficientData
from model.joint_covariance import JointCovariance
from model.poses import (
    Poses,
    compose,
    moved_onto,
    overlap,
    relative,
    wrap,
)

T = np.array([0.0, 1.0, 2.0, 4.0])
LINE = Poses(T, np.column_stack([0.5 * T, 0.0 * T]), 0.1 * T)


def bundle(n=3):
    position = LINE.position + np.arange(n)[:, None, None]
    return Poses(T, position, np.tile(LINE.yaw, (n, 1)))


def test_interpolation_of_a_straight_line_is_exact():
    at = LINE.at([0.5, 3.0])
    np.testing.assert_allclose(at.states, [[0.25, 0, 0.05], [1.5, 0, 0.3]])


@pytest.mark.parametrize("t", [-0.1, 4.1])
def test_nothing_is_extrapolated(t):
    with pytest.raises(DomainError, match="the path runs from 0 to 4 s"):
        LINE.at([t])


def test_states_and_poses_are_inverse():
    again = Poses.of_states(T, bundle().states)
    np.testing.assert_array_equal(again.position, bundle().position)
    np.testing.assert_array_equal(again.yaw, bundle().yaw)


def test_a_single_path_is_one_draw_and_draws_are_paths():
    np.testing.assert_array_equal(LINE.draws().draws(0).states, LINE.states)
    assert bundle().draws(slice(2)).states.shape == (2, 4, 3)
    np.testing.assert_array_equal(bundle().draws(1).position, LINE.position + 1)


def test_some_times_are_taken_of_every_draw_and_of_the_covariance():
    covariance = np.arange(4)[:, None, None] * np.eye(3)
    joint = JointCovariance.independent(covariance)
    part = Poses(T, LINE.position, LINE.yaw, joint).part(slice(1, 3))
    np.testing.assert_array_equal(part.covariance, covariance[1:3])
    assert bundle().part(T < 2).states.shape == (3, 2, 3)


def test_a_motion_keeps_lengths_and_adds_to_headings():
    moved = LINE.moved(rotation=0.7, translation=[1.0, -2.0])
    assert moved.length == pytest.approx(LINE.length) == 2.0
    np.testing.assert_allclose(moved.yaw - LINE.yaw, 0.7)
    np.testing.assert_allclose(moved.position[0], [1.0, -2.0])


@pytest.mark.parametrize(
    "wrong",
    [
        {"t": T[::-1]},
        {"t": T[:3]},
        {"yaw": np.zeros(3)},
        {"position": np.zeros((4, 3))},
        {"position": np.full((4, 2), np.nan)},
        {"joint": JointCovariance.independent(np.zeros((3, 3, 3)))},
    ],
)
def test_what_is_no_path_is_an_error(wrong):
    with pytest.raises(DomainError):
        Poses(**{"t": T, "position": LINE.position, "yaw": LINE.yaw, **wrong})


def test_overlap_needs_two_shared_times():
    assert overlap(LINE, LINE.delayed(1.5)).tolist() == [False, False, True, True]
    with pytest.raises(InsufficientData, match="do both keep the same clock"):
        overlap(LINE, LINE.delayed(3.5))


def test_wrapped_angles_are_within_half_a_turn():
    angles = np.linspace(-20, 20, 101)
    assert np.all((wrap(angles) >= -np.pi) & (wrap(angles) < np.pi))
    np.testing.assert_allclose(np.exp(1j * wrap(angles)), np.exp(1j * angles))


def test_poses_are_composed_with_a_pose_and_seen_from_it_again():
    moves = np.random.default_rng(2).normal(size=(7, 3))
    pose = np.array([1.0, -2.0, 0.7])
    there = compose(pose, moves)
    np.testing.assert_allclose(relative(there, pose), moves)
    np.testing.assert_allclose(relative(there, np.tile(pose, (7, 1))), moves)
    ahead = compose(np.array([1.0, 1.0, np.pi / 2]), np.array([[2.0, 0.0, 0.1]]))
    np.testing.assert_allclose(ahead, [[1.0, 3.0, np.pi / 2 + 0.1]])


def test_paths_are_moved_to_begin_at_a_pose():
    states = np.array([[[1.0, 1.0, 0.5], [2.0, 1.0, 0.6]]])
    moved = moved_onto(states, states[:, 0], np.array([0.0, 0.0, 0.5 + np.pi / 2]))
    np.testing.assert_allclose(
        moved[0], [[0, 0, 0.5 + np.pi / 2], [0, 1, 0.6 + np.pi / 2]], atol=1e-12
    )
