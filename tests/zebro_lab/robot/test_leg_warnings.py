# SPDX-License-Identifier: MIT
"""A warning says what was seen, what was expected and what would repair it; following it does."""

import re
from pathlib import Path

import numpy as np
import pytest

from model.gait.reference import SampledReference
from support.leg_motions import T, tripod
from zebro_lab.robot.leg_warnings import WARNING, leg_warnings

THETA = tripod(1.2).angles(T)


def warn(theta: np.ndarray, **robot) -> tuple[str, ...]:
    return leg_warnings(SampledReference(T, theta), **robot)


def test_a_right_log_gives_no_line():
    assert warn(THETA) == ()


def test_a_reversed_leg_is_named_with_its_repair():
    sign = [1, 1, -1, 1, 1, -1]
    (line,) = warn(THETA * sign)
    assert line.startswith(f"{WARNING}legs 3 and 6 turn backwards and pass -90 deg")
    assert "sign = -1 for theta3 and theta6 in [legs.columns] of the columns.toml of the" in line
    (named,) = warn(THETA * sign, columns=Path("walk/columns.toml"))
    assert "theta3 and theta6 in [legs.columns] of walk/columns.toml, or in legs.sign" in named
    assert warn(THETA * sign, leg_sign=sign) == ()


@pytest.mark.parametrize("zero_deg", [-90, 90, 180])
def test_another_zero_is_repaired_by_the_offsets_that_the_line_names(zero_deg):
    (line,) = warn(THETA + np.radians(zero_deg))
    offsets = re.search(r"offset_deg = \[([^]]*)\] in \[legs\] of robot\.toml", line)
    assert offsets is not None
    named = np.array([float(each) for each in offsets[1].split(",")])
    assert set((named + zero_deg) % 360) == {0}
    assert warn(THETA + np.radians(zero_deg), leg_offset=np.radians(named)) == ()


def test_an_order_by_sides_is_repaired_by_the_columns_that_the_line_names():
    theta = THETA[:, [0, 2, 4, 1, 3, 5]]
    (line,) = warn(theta)
    assert "in the groups 1, 3, 5 / 2, 4, 6" in line
    assert "the left side from front to rear, then the right side" in line
    columns = re.search(
        r"what is now theta(\d), theta(\d), theta(\d), theta(\d), theta(\d), theta(\d)", line
    )
    assert columns is not None
    repaired = theta[:, [int(leg) - 1 for leg in columns.groups()]]
    np.testing.assert_array_equal(repaired, THETA)
    assert warn(repaired) == ()


def test_degrees_taken_for_radians_are_suspected():
    (line,) = warn(np.degrees(THETA))
    assert "are the angles in degrees?" in line


def test_a_walk_backwards_and_a_turn_on_the_spot_are_noted_without_a_warning():
    back = tripod().angles(T[-1] - T)
    assert warn(back) == ("leg log: legs 1, 2, 3, 4, 5 and 6 turn backwards: a walk backwards",)
    spot = np.where(np.arange(6) % 2 == 0, tripod().angles(-T), tripod().angles(T))
    assert warn(spot) == ("leg log: legs 1, 3 and 5 turn backwards: a turn on the spot",)
