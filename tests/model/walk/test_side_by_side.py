# SPDX-License-Identifier: MIT
import pickle
from dataclasses import replace

import numpy as np
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.robot import GRAVITY, Robot
from model.walk.dynamics import DynamicsOptions, integrate, start_state
from model.walk.side_by_side import LevelWalk, OneOfSeveralError, walk_side_by_side
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
TABLE = VelocityCoulomb(0.38).table(weight=ROBOT.mass * GRAVITY)
GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 1.0)
OPTIONS = DynamicsOptions(dt=0.005)


def walks(n=3):
    rng = np.random.default_rng(5)
    t = OPTIONS.dt * np.arange(201)
    return [
        LevelWalk(
            ROBOT, TABLE, replace(OPTIONS, stiffness=2e5 * (1 + i)),
            GAIT.angles(t) + np.radians(1.0) * rng.standard_normal(6),
        )
        for i in range(n)
    ]  # fmt: skip


def test_walks_settle_and_go_as_each_does_alone():
    together = walk_side_by_side(walks())
    for pose, walk in zip(together, walks(), strict=True):
        state = start_state(walk.robot, walk.theta[0], walk.options)
        alone, _ = integrate(walk.robot, walk.table, state, walk.theta, walk.options)
        np.testing.assert_allclose(pose, alone, atol=1e-11)


@pytest.mark.parametrize(("row", "said"), [(0, "cannot stand"), (100, "diverged at t = 0.49")])
def test_the_walk_that_fails_is_named(row, said):
    several = walks()
    several[1].theta[row, 4] = np.inf
    with pytest.raises(OneOfSeveralError, match=said) as caught:
        walk_side_by_side(several)
    assert caught.value.walk == 1


def test_an_error_of_a_worker_comes_back_with_its_walk():
    back = pickle.loads(pickle.dumps(OneOfSeveralError(2, "diverged")))  # noqa: S301
    assert (back.walk, str(back)) == (2, "diverged")
