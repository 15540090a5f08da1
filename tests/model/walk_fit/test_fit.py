# SPDX-License-Identifier: MIT
"""What walks say of the legs, on walks simulated by the model itself: the truth is known."""

import numpy as np
import pytest

from model.errors import InsufficientData
from model.gait import tripod_angles, tripod_reference
from model.gait.reference import SampledReference
from model.joint_covariance import JointCovariance
from model.predict import ModelSpread
from model.robot import Robot
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.traction import VelocityCoulomb
from model.walk_fit.fit import fit_walks
from model.walk_fit.prior import (
    ACROSS,
    WalkPrior,
    WrongLeg,
)
from model.walk_fit.tracked_walk import TrackedWalk

DURATION = 8.0
NOISE = np.array([0.002, 0.002, 0.005])
TABLE = VelocityCoulomb(0.38).table(weight=21.3)
PRIOR = WalkPrior(spread=ModelSpread(0.002, 0.002))


def tracked(steering, side, *, offset, seed, duration=DURATION):
    """Simulate a tracked walk of a robot with leg offsets [rad]."""
    gait = tripod_reference(tripod_angles(np.radians(50.0), steering), 2.0, direction=side)
    t = np.arange(0.0, duration + 0.005, 0.01)
    legs = SampledReference(t, gait.angles(t))
    true = planar_walk(WalkDraw(Robot(leg_offset=offset), legs, TABLE), duration=duration).poses
    seen = np.arange(0.0, duration, duration / 8)
    states = true.at(seen).states
    states += np.random.default_rng(seed).normal(0, 1, states.shape) * NOISE
    covariance = np.tile(np.diag(NOISE**2), (len(seen), 1, 1))
    joint = JointCovariance.independent(covariance)
    return TrackedWalk(f"{steering} {side}", legs, seen, states, joint)


THREE = ((1.0, "left"), (1.3, "left"), (1.3, "right"))


def fitted(offset, *, turns=THREE):
    walks = [
        tracked(steering, side, offset=offset, seed=i) for i, (steering, side) in enumerate(turns)
    ]
    fit = fit_walks(Robot(), TABLE, walks, prior=PRIOR, rng=np.random.default_rng(1))
    return fit.posterior


@pytest.fixture(scope="module")
def straight_legs():
    walk = tracked(1.3, "left", offset=np.zeros(6), seed=0, duration=4.0)
    with pytest.MonkeyPatch.context() as patched:  # no leg is off, so that no case is worth a climb
        patched.setattr("model.walk_fit.modes.CLIMBED", 0)
        fit = fit_walks(Robot(), TABLE, [walk], prior=PRIOR, rng=np.random.default_rng(1))
    return fit.posterior


@pytest.fixture(scope="module")
def bent_leg():
    return fitted(np.radians([0, 0, 0, 5.0, 0, 0]))


def test_legs_that_are_right_are_left_alone(straight_legs):
    assert straight_legs.found()[0].case is None
    for each in straight_legs.contractions():
        assert abs(each.mean) < 2.5 * each.sd


@pytest.mark.long
def test_a_leg_five_degrees_off_is_found_as_closely_as_the_answer_says(bent_leg):
    likeliest = bent_leg.found()[0]
    assert likeliest.case == WrongLeg(3)
    assert likeliest.probability > 0.99
    assert abs(likeliest.offset - np.radians(5.0)) < 2 * likeliest.sd
    assert np.degrees(likeliest.sd) < 2.0


def test_enough_draws_carry_the_answer(straight_legs):
    assert straight_legs.reliable
    assert straight_legs.weight.sum() == pytest.approx(1.0)
    assert sum(each.probability for each in straight_legs.found()) == pytest.approx(1.0)


def test_the_single_path_has_lateral_traction_as_longitudinal_and_draws_have_their_own(
    straight_legs,
):
    assert not straight_legs.best[ACROSS].any()
    drawn = straight_legs.draw(500, rng=np.random.default_rng(5))
    assert np.std(np.log(drawn.lateral_grip)) > 0.05
    assert np.std(np.log(drawn.lateral_stiffness)) > 0.05


def test_no_walk_and_a_track_of_two_poses_are_refused():
    with pytest.raises(InsufficientData, match="no walk"):
        fit_walks(Robot(), TABLE, [], prior=PRIOR, rng=np.random.default_rng(1))
    walk = tracked(1.0, "left", offset=np.zeros(6), seed=1)
    with pytest.raises(InsufficientData, match="expected 3 or more"):
        TrackedWalk("short", walk.legs, walk.t[:2], walk.states[:2], walk.joint.part(slice(2)))
