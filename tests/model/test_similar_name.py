# SPDX-License-Identifier: MIT
"""A misspelt name finds the one that was meant, and another name finds none."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.similar_name import similar_name

COLUMNS = [
    "t", "slip_ratio", "normal_force", "traction_force", "omega_leg", "omega_ground", "x_m", "y_m",
    "yaw_rad", "theta1", "theta2", "radius_leg", "radius_ground", "magic-formula",
]  # fmt: skip


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("normal_froce", "normal_force"), ("normalforce", "normal_force"),
        ("Normal Force", "normal_force"), ("slip-ratio", "slip_ratio"), ("T", "t"),
        ("omega_grund", "omega_ground"), ("yaw_rads", "yaw_rad"), ("radius", "radius_leg"),
        ("magic", "magic-formula"), ("Theta2", "theta2"), ("thta1", "theta1"),
    ],
)  # fmt: skip
def test_a_misspelt_name_finds_the_one_that_was_meant(written, meant):
    assert similar_name(written, COLUMNS) == meant


@pytest.mark.parametrize(
    "name",
    ["lateral_force", "omega_wheel", "z_m", "x", "tau", "theta3", "slip_angle", "colour", "",
     "x" * 10_000],
)  # fmt: skip
def test_another_name_finds_none(name):
    assert similar_name(name, COLUMNS) is None


def test_of_several_the_nearest_is_found_then_the_first():
    assert similar_name("counts_per_turn", ["counts_per_tour", "counts_per_turns"]) == (
        "counts_per_turns"
    )
    assert similar_name("radius", ["radius_ground", "radius_leg"]) == "radius_ground"


@given(st.text("abcdefgh", min_size=8, max_size=20), st.integers(0, 6))
def test_two_letters_swapped_are_one_error(name, at):
    swapped = name[:at] + name[at + 1] + name[at] + name[at + 2 :]
    assert similar_name(swapped, [name]) == name
