# SPDX-License-Identifier: MIT
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.notation import TETRAPOD, TRIPOD, Gait, parse_gait


@st.composite
def gaits(draw):
    """Deal the legs 1 to n, shuffled, into non-empty groups."""
    legs = draw(st.permutations(range(1, draw(st.integers(1, 8)) + 1)))
    cuts = sorted(draw(st.sets(st.integers(1, len(legs) - 1)))) if len(legs) > 1 else []
    ends = [0, *cuts, len(legs)]
    return Gait(tuple(tuple(legs[a:b]) for a, b in pairwise(ends)))


@given(gaits())
def test_printing_and_parsing_is_a_round_trip(gait):
    assert parse_gait(str(gait)).groups == gait.groups


@given(gaits(), st.integers(0, 7))
def test_rotating_the_cycle_leaves_the_gait_the_same(gait, steps):
    steps %= len(gait.groups)
    rotated = Gait(gait.groups[steps:] + gait.groups[:steps])
    assert rotated == gait
    assert hash(rotated) == hash(gait)


def test_reversing_three_groups_is_another_gait():
    assert Gait(TETRAPOD.groups[::-1]) != TETRAPOD
    assert Gait(TRIPOD.groups[::-1]) == TRIPOD


@pytest.mark.parametrize("text", ["{1,4,5}<{2,3,6}", " { 5, 4 ,1} ≺ {2,3,6} ", "{2,3,6} < {1,4,5}"])
def test_spelling_does_not_matter(text):
    assert parse_gait(text, 6) == TRIPOD


def test_each_leg_knows_its_group():
    assert TETRAPOD.group_of.tolist() == [0, 1, 2, 0, 1, 2]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "not a group"),
        ("1,4,5 < 2,3,6", "not a group"),
        ("{1,4,5 < {2,3,6}", "not a group"),
        ("{1,4,5} {2,3,6}", "not a group"),
        ("{1,4,5} < ", "not a group"),
        ("{1,4,5} > {2,3,6}", "not a group"),
        ("{1,2} < {}", "group 2 of the gait is empty"),
        ("{1,4,4} < {2,3,6}", "leg 4 is in the gait more than once"),
        ("{1,4,5} < {2,3,5,6}", "leg 5 is in the gait more than once"),
        ("{1,4} < {2,3,6}", "leg 5 is missing"),
        ("{0,1}", "leg 0"),
        ("{1,a}", "'a' in group {1,a}"),
        ("{1,-2}", "'-2' in group"),
        ("{1,,2}", "'' in group"),
        ("{1} < {2}", "has 2 legs; the robot has 6"),
        ("{" + "9" * 5000 + "}", "a leg number in the gait has 5000 digits"),
        ("{1} < {999999}", "leg 2 is missing"),
    ],
)
def test_errors_name_the_fault(text, fault):
    with pytest.raises(DomainError, match=fault.replace("{", r"\{")):
        parse_gait(text, 6)
