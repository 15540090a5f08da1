# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.robot import N_LEGS
from model.walk_fit.posterior import WalkPosterior, state_in
from model.walk_fit.prior import FLOOR, NAMES, WRONG, WalkPrior, WrongLeg, all_cases

N = 4000


def posterior(*, share_wrong=0.25, scale=0.5):
    """Return draws that are half as wide as the prior, a share of them with leg 3 wrong by 0.1."""
    rng = np.random.default_rng(1)
    prior = WalkPrior()
    values = scale * prior.scale * rng.standard_normal((N, WRONG + 1))
    values[:, WRONG] = 0.1
    cases = all_cases(1)
    case = np.where(np.arange(N) < share_wrong * N, cases.index(WrongLeg(2)), 0)
    best = np.zeros(WRONG + 1)
    return WalkPosterior(prior, ("a",), cases, values, case, np.full(N, 1 / N), best, None, (1.0,))


def test_equal_weights_count_every_draw_and_one_heavy_draw_counts_alone():
    even = posterior()
    assert even.effective == pytest.approx(N)
    assert even.reliable
    weight = np.zeros(N)
    weight[0] = 1.0
    alone = WalkPosterior(**{**vars(even), "weight": weight})
    assert alone.effective == pytest.approx(1.0)
    assert not alone.reliable


def test_contraction_is_what_the_draws_lost_of_the_prior_s_variance():
    told = {each.name: each for each in posterior(share_wrong=0.0).contractions()}
    assert told["grip"].contraction == pytest.approx(0.75, abs=0.03)
    assert told["grip"].informed
    wide = posterior(share_wrong=0.0, scale=1.0).contractions()
    assert not any(each.informed for each in wide if each.name in FLOOR)


def test_cases_are_found_with_their_share_and_the_wrong_leg_s_whole_offset():
    first, second = posterior().found()
    assert (first.case, second.case) == (None, WrongLeg(2))
    assert second.probability == pytest.approx(0.25)
    assert second.offset == pytest.approx(0.1, abs=0.01)
    assert first.offset == 0.0


def test_draws_of_the_legs_count_a_wrong_leg_in_its_share():
    legs = posterior().draw(2000, rng=np.random.default_rng(2))
    off = legs.offset[:, 2] - legs.offset[:, [0, 1, 3, 4, 5]].mean(axis=1)
    assert (off > 0.05).mean() == pytest.approx(0.25, abs=0.04)


def test_another_robot_keeps_the_floor_and_gets_new_legs():
    mine = posterior()
    other = mine.of_floor_alone(rng=np.random.default_rng(3))
    for name in FLOOR:
        column = NAMES.index(name)
        np.testing.assert_array_equal(other.values[:, column], mine.values[:, column])
    assert other.values[:, 0].std() == pytest.approx(mine.prior.offset_sd, rel=0.05)
    assert other.cases == (None,)


def test_states_of_mixed_cases_are_those_of_each_case_alone():
    mine = posterior()
    mixed = state_in(mine.values, mine.case, mine.cases, walk=None)
    plain = state_in(mine.values, np.zeros_like(mine.case), mine.cases, walk=None)
    wrong = mine.case != 0
    np.testing.assert_allclose(mixed.offset[wrong, 2], plain.offset[wrong, 2] + 0.1)
    np.testing.assert_array_equal(mixed.offset[~wrong], plain.offset[~wrong])
    assert mixed.offset.shape == (N, N_LEGS)
