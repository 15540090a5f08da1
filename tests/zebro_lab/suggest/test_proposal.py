# SPDX-License-Identifier: MIT
"""A proposal fills the time, keeps a skeleton, and leaves less than even or quadratic slips."""

from dataclasses import replace

import numpy as np
import pytest

from model.design.choose import SKELETON, spaced
from model.design.targets import force_target, parameter_target
from model.errors import InsufficientData
from support.suggestions import TIME, knowledge, plan, suggested
from zebro_lab.suggest.proposal import (
    as_planned,
    candidates,
    durations,
    in_passes,
    load_choices,
    most_slips,
    propose,
    seconds_of,
    shortest,
)


def targets(known, name="slip_stiffness"):
    return [parameter_target(known.posterior, known.draws, name)]


def test_a_proposal_takes_the_time_that_is_given_and_keeps_the_skeleton():
    found = suggested().proposal
    assert TIME - 5 < found.seconds <= TIME
    assert found.counts.sum() == len(found.plan.points.slips)
    skeleton = np.round(spaced(-0.2, 0.8, SKELETON), 4)
    assert set(skeleton.tolist()) <= set(found.slips.tolist())
    assert found.counts.max() > 1


@pytest.mark.parametrize("alone", [False, True])
@pytest.mark.parametrize("name", ["slip_stiffness", "friction"])
def test_it_leaves_less_than_even_and_quadratic_slips_in_the_same_time(alone, name):
    known = knowledge(alone=alone)
    found = propose(plan(), known, targets(known, name), seconds=TIME)
    for make in (lambda n: np.linspace(-0.2, 0.8, n), lambda n: spaced(-0.2, 0.8, n)):
        count = most_slips(plan(), TIME, least=3) - 1  # spaced rounds up
        other = plan(slips=tuple(make(count).tolist()))
        assert seconds_of(other) <= TIME
        assert found.design.objective < as_planned(other, known, targets(known, name)).objective


def test_more_time_never_leaves_more():
    known = knowledge()
    left = [propose(plan(), known, targets(known), seconds=s).design.objective
            for s in (160.0, 240.0, 480.0)]  # fmt: skip
    assert left[0] > left[1] > left[2]


def test_alone_the_calibrations_data_are_forgotten():
    together, alone = knowledge(), knowledge(alone=True)
    assert (together.now == alone.now).all()
    assert np.linalg.det(together.before[0]) > np.linalg.det(alone.before[0])
    assert alone.before[0].tolist() == np.eye(len(alone.before[0])).tolist()


def test_several_targets_share_a_proposal():
    known = knowledge()
    at = {"slips": np.array([0.3]), "loads": np.array([5.0])}
    both = [*targets(known), force_target(known.posterior, known.draws, name="f", **at)]
    shares = []
    found = propose(plan(), known, both, seconds=TIME, progress=shares.append)
    each = np.mean([t.log_sd(found.design.covariance).mean() for t in both])
    assert found.design.objective == pytest.approx(each)
    assert shares == sorted(shares)
    assert shares[0] == 0


def test_a_time_too_short_says_what_is_needed():
    known = knowledge()
    with pytest.raises(
        InsufficientData, match=r"20 s are too short for 7 slips.* expected (\d+) s"
    ):
        propose(plan(), known, targets(known), seconds=20.0)
    least = shortest(plan(), durations(plan(), known), SKELETON)
    assert propose(plan(), known, targets(known), seconds=least).seconds == pytest.approx(least)


def test_repeats_and_both_directions_count_as_planned():
    known = knowledge()
    once = as_planned(plan(), known, targets(known))
    twice = as_planned(plan(repeats=2), known, targets(known))
    both = as_planned(plan(order="up-down"), known, targets(known))
    assert once.counts.sum() == 12
    assert (twice.counts.sum(), both.counts.sum()) == (24, 23)
    assert twice.objective < both.objective < once.objective


def test_up_and_down_becomes_passes():
    known = knowledge()
    found = propose(plan(order="up-down", repeats=3), known, targets(known), seconds=TIME).plan
    assert (found.points.order, found.points.repeats) == ("monotone", 1)
    assert in_passes(np.array([-0.1, 0.2, 0.5]), np.array([1, 3, 2])) == (
        -0.1, 0.2, 0.5, 0.2, 0.5, 0.2
    )  # fmt: skip


def test_candidates_stay_within_the_plans_slips_and_hold_them():
    every, kept = candidates((0.05, 0.3, 0.6))
    assert (every.min(), every.max()) == (0.05, 0.6)
    assert {0.05, 0.3, 0.6} <= set(every.tolist())
    assert len(kept) == SKELETON
    signed, _ = candidates((-0.1, 0.5))
    assert (signed < 0).any()
    assert 0.0 in signed


def test_loads_are_all_or_the_ends():
    assert load_choices((3.0, 9.0, 3.0)) == ((3.0, 9.0),)
    assert load_choices((9.0, 5.0, 3.0)) == ((9.0, 5.0, 3.0), (9.0, 3.0))


def test_durations_hold_a_block_and_the_window():
    tried = durations(plan(duration=1.0), knowledge())
    assert tried[0] == pytest.approx(0.2)
    assert (1.0 in tried, tried[-1]) == (True, 4.0)
    slow = durations(plan(), replace(knowledge(), rate=4.0))
    assert slow == (5.0,)


def test_the_most_slips_fit_and_one_more_does_not():
    count = most_slips(plan(), TIME, least=3)
    assert seconds_of(plan(slips=(0.0,) * count)) <= TIME
    assert seconds_of(plan(slips=(0.0,) * (count + 1))) > TIME
    assert most_slips(plan(), 10.0, least=3) is None
