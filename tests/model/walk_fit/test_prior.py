# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError
from model.walk_fit.prior import (
    ACROSS,
    FALL,
    NAMES,
    WRONG,
    WalkPrior,
    WrongLeg,
    all_cases,
    describe,
    leg_offsets,
    legs_of,
    wrong_legs,
)


@pytest.mark.parametrize("walks", [1, 2, 5])
def test_probabilities_of_all_cases_add_up_to_one(walks):
    prior = WalkPrior()
    total = sum(np.exp(prior.log_probability(case, walks=walks)) for case in all_cases(walks))
    assert total == pytest.approx(1.0)


def test_one_walk_cannot_tell_its_own_wrong_leg_from_one_in_all():
    assert all(leg.walk is None for leg in wrong_legs(1))
    assert len(wrong_legs(3)) == 6 + 3 * 6


def test_a_wrong_leg_moves_its_own_offset_in_its_own_walk_alone():
    values = np.zeros((1, WRONG + 1))
    values[0, WRONG] = 0.1
    knocked = WrongLeg(2, walk=1)
    np.testing.assert_array_equal(leg_offsets(values, knocked, walk=0), np.zeros((1, 6)))
    expected = np.array([[0, 0, 0.1, 0, 0, 0]])
    np.testing.assert_array_equal(leg_offsets(values, knocked, walk=1), expected)
    np.testing.assert_array_equal(leg_offsets(values, WrongLeg(2), walk=0), expected)


def test_parameters_at_zero_are_the_robot_as_described():
    legs = legs_of(np.zeros((2, WRONG + 1)), None)
    assert not legs.offset.any()
    assert not legs.arc.any()
    assert not legs.steering.any()
    np.testing.assert_array_equal(legs.grip, 1.0)
    np.testing.assert_array_equal(legs.stiffness, 1.0)
    np.testing.assert_array_equal(legs.fall, FALL)


def test_the_common_offset_moves_every_leg_and_factors_are_logarithms():
    values = np.zeros((1, WRONG + 1))
    values[0, NAMES.index("common_offset")] = 0.02
    values[0, NAMES.index("grip")] = np.log(1.5)
    values[0, NAMES.index("fall")] = 100.0
    legs = legs_of(values, None)
    np.testing.assert_allclose(legs.offset, 0.02)
    assert legs.grip[0] == pytest.approx(1.5)
    assert legs.fall[0] == 1.5


def test_a_leg_that_may_be_wrong_widens_the_prior_of_its_offset():
    prior = WalkPrior(offset_sd=0.01, wrong_sd=0.1, wrong=0.6)
    assert prior.sd(1)[0] == pytest.approx(np.sqrt(0.01**2 + 0.1 * 0.1**2))


def test_lateral_traction_is_a_factor_of_its_own_and_may_be_held_at_one():
    values = np.zeros((1, WRONG + 1))
    values[0, ACROSS] = np.log([1.2, 0.9])
    legs = legs_of(values, None)
    assert legs.lateral_grip[0] == pytest.approx(1.2)
    assert legs.lateral_stiffness[0] == pytest.approx(0.9)
    assert legs.grip[0] == 1.0
    np.testing.assert_array_equal(WalkPrior(lateral_sd=0.0).scale[ACROSS], 0.0)
    with pytest.raises(DomainError, match="lateral_grip"):
        WalkPrior(lateral_sd=-0.1)


@pytest.mark.parametrize("wrong", [{"offset_sd": 0.0}, {"wrong": 1.0}, {"wrong": 0.0}])
def test_an_impossible_prior_is_an_error(wrong):
    with pytest.raises(DomainError):
        WalkPrior(**wrong)


def test_cases_are_described_by_leg_number_and_walk():
    assert describe(None, ["a"]) == "no leg"
    assert describe(WrongLeg(0), ["a", "b"]) == "leg 1"
    assert describe(WrongLeg(5, walk=1), ["a", "b"]) == "leg 6 in b"
