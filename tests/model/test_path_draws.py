# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.steering import tripod_angles, tripod_reference
from model.path_draws import anchored, bent, bent_walk, quantiles, states_at
from model.poses import Poses
from model.robot import GRAVITY, Robot
from model.walk.bend import Bend
from model.walk.dynamics import walk
from model.walk.ground import FLAT, with_slope
from model.walk.traction import VelocityCoulomb

T = np.linspace(0.0, 4.0, 41)


def straight(m=3) -> Poses:
    x = np.broadcast_to(0.1 * T, (m, len(T)))
    return Poses(T, np.stack([x, 0 * x], axis=-1), np.zeros((m, len(T))))


def test_a_bent_straight_line_is_a_circle():
    paths = bent(straight(), distance=np.zeros(3), curvature=np.array([0.0, 1.0, -2.0]))
    end = paths.position[:, -1]
    np.testing.assert_allclose(end[0], [0.4, 0], atol=1e-12)
    np.testing.assert_allclose(end[1], [np.sin(0.4), 1 - np.cos(0.4)], atol=1e-5)
    np.testing.assert_allclose(paths.yaw[:, -1], [0, 0.4, -0.8])


@given(stretch=st.floats(-0.1, 0.1))
def test_a_stretched_path_is_longer_by_as_much_and_turns_as_before(stretch):
    paths = bent(straight(), distance=np.full(3, stretch), curvature=np.zeros(3))
    np.testing.assert_allclose(paths.position[:, -1, 0], 0.4 * (1 + stretch))
    np.testing.assert_array_equal(paths.yaw, 0)


def test_an_anchored_path_passes_the_pose_at_its_time():
    rng = np.random.default_rng(1)
    curved = bent(straight(), distance=np.zeros(3), curvature=np.array([0.1, 1.0, -2.0]))
    paths = anchored(curved, np.array([2.0, -1.0, 0.7]), at=1.23, rng=rng)
    here = states_at(paths, np.array([1.23]))[:, 0]
    np.testing.assert_allclose(here, np.broadcast_to([2.0, -1.0, 0.7], (3, 3)), atol=1e-12)
    moved = np.linalg.norm(np.diff(paths.position, axis=1), axis=2)
    np.testing.assert_allclose(moved, np.linalg.norm(np.diff(curved.position, axis=1), axis=2))
    with pytest.raises(DomainError, match="known pose"):
        anchored(curved, np.zeros(3), at=9.0, rng=rng)


def test_an_uncertain_pose_spreads_the_paths_as_much():
    rng = np.random.default_rng(1)
    covariance = np.diag([0.01, 0.02, 0.05]) ** 2
    paths = anchored(straight(4000), np.zeros(3), at=0.0, covariance=covariance, rng=rng)
    np.testing.assert_allclose(
        states_at(paths, T[:1])[:, 0].std(axis=0), [0.01, 0.02, 0.05], rtol=0.05
    )


def test_quantiles_are_ordered_and_hold_the_share_they_say():
    rng = np.random.default_rng(1)
    paths = anchored(straight(2000), np.zeros(3), at=0.0, covariance=np.eye(3) * 1e-4, rng=rng)
    band = quantiles(paths, (0.05, 0.5, 0.95))
    assert np.all(np.diff(band, axis=0) >= 0)
    inside = (band[0, -1, 1] <= paths.position[:, -1, 1]) & (
        paths.position[:, -1, 1] <= band[2, -1, 1]
    )
    assert inside.mean() == pytest.approx(0.9, abs=0.01)


def test_a_walk_bent_on_a_slope_stays_on_it():
    robot, slope = Robot(), with_slope(FLAT, np.radians(5.0), np.radians(-3.0))
    law = VelocityCoulomb(0.5).table(weight=robot.mass * GRAVITY)
    gait = tripod_reference(tripod_angles(np.radians(50.0), 1.0), 2.0)
    path = walk(robot, gait, law, duration=3.0, ground=slope)
    moved = bent_walk(path, Bend(0.05, 1.0), slope)
    assert moved.yaw[-1] - path.yaw[-1] > 0.1

    def over(one):
        return one.position @ [-slope.slope_x, -slope.slope_y, 1.0]

    np.testing.assert_allclose(over(moved), over(path), atol=1e-12)
