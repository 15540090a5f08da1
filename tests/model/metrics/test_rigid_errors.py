# SPDX-License-Identifier: MIT
"""Errors of rigid paths: independent of the frame, and of pairs found exhaustively."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from model.errors import InsufficientData
from model.metrics.rigid_errors import pairs_by_distance, rigid_errors, rotation_angles
from model.rigid_path import RigidPath
from support.foreign_trajectories import drive


def path(**options) -> RigidPath:
    t, position, rotation = drive(**options)
    return RigidPath(t, position, rotation.as_matrix())


def moved(given: RigidPath, turn: Rotation, shift) -> RigidPath:
    return RigidPath(given.t, turn.apply(given.position) + shift, turn.as_matrix() @ given.rotation)


def test_a_moved_path_has_neither_aligned_nor_relative_errors():
    turn = Rotation.from_rotvec([0.4, 0.2, -2.0])
    errors = rigid_errors(moved(path(), turn, [3, -4, 0.5]), path(), distances=(1.0, 2.0))
    assert errors.ate.rms > 1
    assert errors.aligned.largest < 1e-9
    assert errors.rotation == pytest.approx(turn.magnitude())
    for each in (errors.steps, *errors.relative):
        assert each.pairs > 20
        assert max(each.position, each.angle) < 1e-9


def test_a_path_of_another_scale_has_no_errors_once_the_scale_is_corrected():
    errors = rigid_errors(path().scaled(0.25), path(), distances=(1.0,), correct_scale=True)
    assert errors.scale == pytest.approx(4.0)
    assert max(errors.ate.largest, errors.steps.position, errors.relative[0].position) < 1e-9


def test_a_path_without_rotations_has_no_relative_errors():
    errors = rigid_errors(replace(path(), rotation=None), path(noise=0.1), distances=(1.0,))
    assert np.isnan([errors.steps.position, errors.rotation, errors.relative[0].angle]).all()
    assert errors.relative[0].pairs > 0


def test_one_pose_is_too_few():
    one = path().part(np.array([0]))
    with pytest.raises(InsufficientData, match="1 pose to compare"):
        rigid_errors(one, one)


@pytest.mark.parametrize("seed", range(10))
def test_pairs_by_distance_are_those_of_an_exhaustive_search(seed):
    rng = np.random.default_rng(seed)
    steps = rng.uniform(0, 0.3, 150) * (rng.uniform(size=150) > 0.3)  # it stands now and then
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    gap = np.abs(travelled[None, :] - travelled[:, None] - 1.0)
    gap[np.tril_indices(len(travelled))] = np.inf
    end = gap.argmin(axis=1)
    start = np.flatnonzero(gap[np.arange(len(travelled)), end] <= 0.1)
    found = pairs_by_distance(travelled, 1.0)
    np.testing.assert_array_equal(found[0], start)
    np.testing.assert_array_equal(found[1], end[start])


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1.0, np.pi - 1e-9, np.pi])
def test_angles_of_rotations_are_exact_near_both_ends(angle):
    turn = Rotation.from_rotvec(angle * np.array([0.6, 0.0, 0.8])).as_matrix()
    assert rotation_angles(turn[None])[0] == pytest.approx(angle, abs=1e-12)
    c, s = np.cos(angle), np.sin(angle)
    assert rotation_angles(np.array([[[c, -s], [s, c]]]))[0] == pytest.approx(angle, abs=1e-12)
