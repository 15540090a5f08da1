# SPDX-License-Identifier: MIT
"""A plan's file: every key is checked, and faults name it."""

import math

import pytest

from rig.errors import ProfileError
from rig.experiment.steps import Point, spell_out


def points(plan):
    return [step for step in spell_out(plan) if isinstance(step, Point)]


def test_turns_are_the_leg_discs(lab):
    changes = {"length": "turns", "turns": 3.0}
    with pytest.raises(ProfileError, match=r"points\.duration: unknown key"):
        lab["plan"](points=changes)  # a duration that is not followed is an error
    plan = lab["plan"](points=changes, drop=("points", "duration"))
    assert plan.points.duration == pytest.approx(3 * 2 * math.pi / 12.0)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"limits": {"normal_froce": 1.0}}, "limits.normal_froce: unknown key; did you mean 'norm"),
        ({"points": {"order": "sideways"}}, "points.order: found 'sideways'; expected one of mono"),
        ({"points": {"slips": [1.2]}}, "points.slips: found 1.2; expected at most 1"),
        ({"points": {"slips": []}}, r"points.slips: found \[\]; expected a list of 1 to"),
        ({"points": {"slips": {"first": 0.0, "lost": 1.0, "count": 3}}}, "slips.last: is missing"),
        ({"points": {"loads": [0.0]}}, "points.loads: found 0 N; expected loads above 0 N"),
        ({"points": {"sweep": 1}}, "points.sweep: found 1; expected true or false"),
        (
            {"load": {"set_by": "axis"}},
            "load.set_by: found 'axis'; set the load by hand: set_by = ",
        ),
        ({"settle": {"timeout": 0.1}}, "settle.timeout: found 0.1 s; expected at least the wind"),
    ],
)
def test_a_malformed_plan_is_refused_and_the_place_named(lab, changes, said):
    with pytest.raises(ProfileError, match=said):
        lab["plan"](**changes)


@pytest.mark.parametrize(
    ("limit", "said"),
    [
        ({"silence": 1.5}, r"limits.silence: found 1.5 s; above 1 s"),
        ({"speed_error_time": 1.5}, r"limits.speed_error_time: found 1.5 s; above 1 s"),
        ({"speed_error": 6.5}, r"limits.speed_error: found 6.5 rad/s; above 6 rad/s"),
        ({"in_a_row": 11}, r"limits.in_a_row: found 11 samples; above 10"),
        ({"reading_age": 1.5}, r"limits.reading_age: found 1.5 s; above 1 s"),
        ({"frozen": 1.5}, r"limits.frozen: found 1.5 s; above 1 s"),
        ({"rest_speed": 1.5}, r"limits.rest_speed: found 1.5 rad/s; above 1 rad/s"),
    ],
)
def test_a_limit_so_high_that_its_guard_is_off_is_refused(lab, limit, said):
    with pytest.raises(ProfileError, match=said):
        lab["plan"](limits=limit)


def test_a_guard_is_off_only_where_it_is_named_so(lab):
    plan = lab["plan"](limits={"silence": 1.5, "frozen": 9.0, "guards_off": ["silence", "frozen"]})
    assert plan.limits.guards_off_text == "silence (1.5 s), frozen (9 s)"
    assert lab["plan"]().limits.guards_off_text == ""
    with pytest.raises(ProfileError, match=r"names 'silence', but limits.silence is 0.25 s"):
        lab["plan"](limits={"guards_off": ["silence"]})
    with pytest.raises(ProfileError, match=r"guards_off: found \['everything'\]; expected a list"):
        lab["plan"](limits={"guards_off": ["everything"]})


def test_an_even_series_has_both_ends(lab):
    plan = lab["plan"](points={"slips": {"first": 0.0, "last": 1.0, "count": 62}})
    assert len(plan.points.slips) == 62
    assert (plan.points.slips[0], plan.points.slips[-1]) == (0.0, 1.0)
    assert math.isclose(plan.points.slips[1], 1 / 61)
