# SPDX-License-Identifier: MIT
"""The identities that the thesis's published numbers must satisfy, to their printed digits."""

import math
import tomllib
from pathlib import Path

import pytest

from model.slip import MagicFormula, SlipDefinition

FOLDER = Path(__file__).parents[2] / "datasets" / "thesis"
PARAMETERS = tomllib.loads((FOLDER / "parameters.toml").read_text(encoding="utf-8"))
TABLES = tomllib.loads((FOLDER / "tables.toml").read_text(encoding="utf-8"))
TURNS = tuple(f"table_5_{number}" for number in range(1, 6))
ON_THE_ROBOT = TURNS[2:]
SIDES = ("inner", "outer")
HALF_DIGIT = math.radians(0.05)


def radians(angles):
    """Convert a column of a table, whichever unit it wears, without its unit in the names."""
    return {
        name.removesuffix("_deg"): math.radians(value) if name.endswith("_deg") else value
        for name, value in angles.items()
    }


def steering(angles):
    """Compute the steering factor from the angles, Eq. (2-18)."""
    outer = angles["outer_liftoff"] - angles["outer_touchdown"]
    return outer / (angles["inner_liftoff"] - angles["inner_touchdown"])


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", TURNS)
def test_simulated_liftoff_is_where_hip_height_equals_that_of_touchdown(name, side):
    angles = radians(TABLES[name]["simulated"])
    touchdown, liftoff = angles[f"{side}_touchdown"], angles[f"{side}_liftoff"]
    expected = math.pi - math.asin((math.sin(touchdown) + 1) / 2)  # Eq. (2-17)
    digit = 1e-4 if name in ("table_5_1", "table_5_2") else 2 * HALF_DIGIT
    assert liftoff == pytest.approx(expected, abs=digit)


@pytest.mark.parametrize("name", TURNS)
def test_simulated_angles_give_the_steering_factor(name):
    assert steering(radians(TABLES[name]["simulated"])) == pytest.approx(
        TABLES[name]["steering_factor"], abs=3e-3
    )


@pytest.mark.parametrize(
    ("name", "effective"), [("table_5_3", 1.075), ("table_5_4", 1.2525), ("table_5_5", 1.41625)]
)
def test_measured_angles_give_a_lower_steering_factor(name, effective):
    found = steering(radians(TABLES[name]["measured"]))
    assert found == pytest.approx(effective)
    assert found < TABLES[name]["steering_factor"]


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", ON_THE_ROBOT)
def test_longer_real_arc_lifts_off_later_from_the_same_touchdown(name, side):
    simulated, measured = TABLES[name]["simulated"], TABLES[name]["measured"]
    assert measured[f"{side}_touchdown_deg"] == simulated[f"{side}_touchdown_deg"]
    assert measured[f"{side}_liftoff_deg"] > simulated[f"{side}_liftoff_deg"] + 10


def test_inertia_is_that_of_a_uniform_cuboid():
    robot = PARAMETERS["robot"]
    length, width, height = (robot[f"body_{side}"] for side in ("length", "width", "height"))
    twelfth = robot["mass"] / 12
    assert robot["inertia"] == pytest.approx(
        {
            "xx": twelfth * (width**2 + height**2),
            "yy": twelfth * (length**2 + height**2),
            "zz": twelfth * (width**2 + length**2),
        }
    )


def test_odd_legs_stand_left_and_even_legs_right():
    robot = PARAMETERS["robot"]
    for leg, (x, y, z) in robot["hips"].items():
        row, side = divmod(int(leg) - 1, 2)
        assert x == (robot["hip_x"], 0.0, -robot["hip_x"])[row]
        assert y == (robot["hip_y"], -robot["hip_y"])[side]
        assert z == 0.0


def test_both_readings_of_the_hips_sideways_distance_are_kept():
    robot = PARAMETERS["robot"]
    assert robot["half_body_width"] == robot["body_width"] / 2
    assert robot["half_body_width"] - robot["hip_y"] == pytest.approx(0.01)
    assert robot["hip_x"] == robot["body_length"] / 2


def test_leg_angle_resolution_is_a_turn_over_its_steps():
    encoder = PARAMETERS["leg_encoder"]
    assert encoder["resolution_deg"] * encoder["steps_per_turn"] == pytest.approx(360)


def test_published_slip_curve_is_a_valid_law_at_every_published_load():
    curve, listing = PARAMETERS["magic_formula"], PARAMETERS["magic_formula_listing"]
    mu, loads = listing["peak_force_per_load"], PARAMETERS["slip_rig"]["normal_forces"]
    values = (curve["B"] * curve["C"] * mu, curve["C"], mu, listing["peak_slip_per_load"])
    law = MagicFormula()
    assert law.valid(loads, values).all()
    assert law.peak_slip(loads, values)[[0, -1]] == pytest.approx([0.014, 0.084], abs=5e-4)
    assert SlipDefinition(curve["slip_definition"]) is SlipDefinition.MATERIAL


def test_tetrapod_sequence_changes_by_legs_and_closes():
    sequence = [set(legs) for legs in TABLES["tetrapod_simulated"]["simulated"]["contact_sequence"]]
    for now, after in zip(sequence, sequence[1:] + sequence[:1], strict=True):
        assert len(now) >= 3
        assert now & after
        assert now != after


@pytest.mark.parametrize("tables", [PARAMETERS, TABLES], ids=["parameters", "tables"])
def test_every_table_says_where_it_stands(tables):
    for name, table in tables.items():
        assert table["where"], name
        assert 1 <= table["page"] <= 110, name


def test_every_walk_is_labelled_simulated_or_measured():
    assert all({"simulated", "measured"} & set(table) for table in TABLES.values())
