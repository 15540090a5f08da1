# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.joint_covariance import JointCovariance
from model.predict import ModelSpread
from model.robot import Robot
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.traction import VelocityCoulomb
from model.walk_fit.misfit import WalkMisfit, walk_states
from model.walk_fit.prior import WRONG, legs_of
from model.walk_fit.tracked_walk import TrackedWalk

TABLE = VelocityCoulomb(0.38).table(weight=21.3)
NOISE = np.array([0.001, 0.001, 0.003])
STEERING, STRIDE = WRONG - 2, WRONG - 1


@pytest.fixture(scope="module")
def walk():
    gait = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0)
    t = np.arange(0.0, 6.005, 0.01)
    legs = SampledReference(t, gait.angles(t))
    seen = np.arange(0.0, 6.0, 1.0)
    states = planar_walk(WalkDraw(Robot(), legs, TABLE), duration=6.0).poses.at(seen).states
    joint = JointCovariance.independent(np.tile(np.diag(NOISE**2), (len(seen), 1, 1)))
    return TrackedWalk("walk", legs, seen, states, joint)


@pytest.fixture(scope="module")
def misfit(walk):
    rng = np.random.default_rng(1)
    spread = ModelSpread(0.002, 0.002)
    return WalkMisfit.of(Robot(), TABLE, walk, spread=spread, rng=rng)


def legs(*, steering=0.0, stride=0.0):
    values = np.zeros((1, WRONG + 1))
    values[0, STEERING], values[0, STRIDE] = steering, stride
    state = legs_of(values, None)
    state.fall[:] = 1.0
    return state


def residuals(misfit, state):
    return misfit.residuals(state, *walk_states([misfit], [state]))


def squares(residuals):
    return float((residuals**2).sum())


def test_the_walk_as_it_was_has_the_least_residuals(misfit):
    assert misfit.size == 3 * 5
    here = squares(residuals(misfit, legs()))
    assert here < 1.0
    for bend in ({"steering": 0.2}, {"steering": -0.2}, {"stride": 0.1}, {"stride": -0.1}):
        assert squares(residuals(misfit, legs(**bend))) > here + 10


def test_terms_say_what_residuals_do_for_small_steering_and_stride(misfit):
    terms = misfit.terms(*walk_states([misfit], [legs()]), steering=1e-3, stride=1e-3)
    y = np.array([[0.7, -0.4]])
    bent = residuals(misfit, legs(steering=0.7e-3, stride=-0.4e-3))
    assert terms.squares_at(y)[0, 0] == pytest.approx(squares(bent), rel=0.02, abs=1e-3)
