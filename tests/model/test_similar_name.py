# SPDX-License-Identifier: MIT
"""A misspelt name finds the one that was meant, and another name finds none."""

import pytest

from model.similar_name import nearest, similar_name

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
        ("omega_gruond", "omega_ground"), ("yaw_rda", "yaw_rad"),
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


def test_of_several_the_nearest_is_found():
    assert similar_name("counts_per_turn", ["counts_per_tour", "counts_per_turns"]) == (
        "counts_per_turns"
    )
    assert similar_name("radius", ["radius_ground", "radius_leg"]) == "radius_leg"


def test_advice_on_a_name_like_no_other_is_the_list_alone():
    assert nearest("FZ", ["t", "Fz"]) == "did you mean 'Fz'? known: 't', 'Fz'"
    assert nearest("colour", ["t", "w"]) == "known: 't', 'w'"


def test_a_long_list_is_cut_and_counted():
    advice = nearest("zzz", [f"column_{number:03d}" for number in range(40)])
    assert "'column_014'" in advice
    assert "'column_015'" not in advice
    assert advice.endswith("and 25 more")
