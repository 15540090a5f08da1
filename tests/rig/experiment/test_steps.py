# SPDX-License-Identifier: MIT
"""A plan becomes steps: every point once an attempt, loads changed as seldom as can be."""

import itertools
from collections import Counter

import pytest

from rig.errors import LimitExceeded, ProfileError
from rig.experiment.steps import Point, Tare, estimate, require_allowed, spell_out, steps_left
from rig.slip_rig.profile import load_rig_profile

PROFILE = load_rig_profile("rig-board-serial")


def points(plan):
    return [step for step in spell_out(plan) if isinstance(step, Point)]


@pytest.mark.parametrize("order", ["monotone", "shuffled", "up-down"])
def test_every_slip_is_measured_at_every_load(lab, order):
    plan = lab["plan"](points={"order": order})
    seen = {(point.load, point.slips[0]) for point in points(plan)}
    assert seen == {(load, slip) for load in (4.0, 8.0) for slip in (0.02, 0.2, 0.8)}


@pytest.mark.parametrize("seed", [0, 1, 77])
def test_a_shuffle_depends_on_its_seed_alone(lab, seed):
    plan, other = (lab["plan"](points={"order": "shuffled", "seed": s}) for s in (seed, seed + 5))
    assert spell_out(plan) == spell_out(plan)
    assert spell_out(plan) != spell_out(other)


def test_up_and_down_meets_every_slip_from_both_sides(lab):
    plan = lab["plan"](points={"order": "up-down"})
    found = [(p.slips[0], p.direction) for p in points(plan) if p.load == 4.0]
    assert found == [(0.02, "up"), (0.2, "up"), (0.8, "up"), (0.2, "down"), (0.02, "down")]


def test_loads_are_set_as_seldom_as_can_be(lab):
    plan = lab["plan"](points={"order": "shuffled", "repeats": 3})
    loads = [point.load for point in points(plan)]
    assert sum(a != b for a, b in itertools.pairwise(loads)) == 1
    assert Counter(loads) == {4.0: 9, 8.0: 9}


def test_zeros_and_check_points_come_as_often_as_asked(lab):
    plan = lab["plan"](controls={"tare_every": 2, "check_every": 3, "check_slip": 0.5})
    steps = spell_out(plan)
    assert [step.number for step in steps] == list(range(1, len(steps) + 1))
    assert sum(isinstance(step, Tare) for step in steps) == 3
    assert sum(isinstance(s, Point) and s.kind == "check" for s in steps) == 2


def test_a_sweep_is_one_run_a_load_through_all_slips(lab):
    found = points(lab["plan"](points={"sweep": True}))
    assert [point.load for point in found] == [4.0, 8.0]
    assert [found[0].slip_at(f) for f in (0.0, 0.25, 0.5, 1.0)] == pytest.approx(
        [0.02, 0.11, 0.2, 0.8]
    )


@pytest.mark.parametrize(
    ("done", "left"),
    [
        ((), "tppptppp"),
        ((2, 3), "tptppp"),
        ((2, 3, 4), "tppp"),
        ((2, 3, 4, 6, 7), "tp"),
        ((2, 3, 4, 6, 7, 8), ""),
    ],
)
def test_what_is_left_of_a_plan_begins_with_a_zero_and_holds_none_in_vain(done, left):
    steps = [Tare(k) if k in (1, 5) else Point(k, 5.0, (0.1,)) for k in range(1, 9)]
    found = steps_left(steps, done)
    assert "".join("t" if isinstance(step, Tare) else "p" for step in found) == left
    assert not {step.number for step in found} & set(done)


def test_the_estimate_counts_points_loads_and_time(lab):
    plan = lab["plan"](load={"patience": 10.0})
    found = estimate(plan, spell_out(plan))
    assert (found.points, found.loads) == (6, 3)
    assert found.seconds == pytest.approx(3 * (10 + 0.6) + 0.3 + 6 * (0.15 + 0.2 + 0.3))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"points": {"omega_leg": 45.0}},
            r"omega_leg \(limits.speed\) is 45 rad/s; its limit is 40",
        ),
        ({"points": {"loads": [26.0]}}, r"Fn 26 N .* is 26 N; its limit is 25 N"),
        ({"points": {"slips": [-12.0]}}, r"ground disc's speed .* 45.5 rad/s; its limit is 40"),
        (
            {"limits": {"normal_force": 31.0}},
            r"limits.normal_force, .* is 31 N; its limit is 30 N",
        ),
    ],
)
def test_a_plan_beyond_a_limit_is_refused_before_motion(lab, changes, said):
    twin = lab["twin"]()
    plan = lab["plan"](**changes)
    with pytest.raises(LimitExceeded, match=said):
        require_allowed(plan, PROFILE)
    with pytest.raises(LimitExceeded, match=said):
        twin.run(plan)
    assert twin.clock.now() == 0
    assert twin.sink.events == []


def test_a_limit_on_what_the_rig_cannot_measure_is_refused_before_motion(lab):
    twin = lab["twin"]()  # a board's, which tells no temperature
    with pytest.raises(ProfileError, match=r"temperature_celsius is 80 degC, but no device"):
        twin.run(lab["plan"](limits={"temperature_celsius": 80.0}))
    assert twin.sink.events == []
