# SPDX-License-Identifier: MIT
"""Units are found in headers, and names in brackets are not taken for units."""

import pytest

from zebro_lab.tables.header_units import (
    suffix_unit,
    unit_in_header,
)


@pytest.mark.parametrize(
    ("header", "unit"),
    [
        ("F [daN]", "daN"), ("F {kN}", "kN"), ("Winkel <°>", "°"), ("[daN] Normalkraft", "daN"),
        ("F [kN], gefiltert", "kN"), ("t [0.1 ms]", "0.1 ms"), ("F (10 N)", "10 N"),
        ("Winkel (links) [°]", "°"), ("Winkel [°] (links)", "°"), ("n / min⁻¹", "min⁻¹"),
        ("hip (front left)", None), ("Winkel (Bein 3)", None), ("Zeit  1 - Standardmessrate", None),
        ("Rot[0]", None), ("q_RS_w []", None), ("F (ch 1)", None), ("acc (x-axis)", None),
        ("F [Kraft]", "Kraft"), ("F (Kraft)", None), ("t (us/10)", "us/10"),
    ],
)  # fmt: skip
def test_a_header_states_a_unit_or_what_may_be_one(header, unit):
    assert unit_in_header(header) == unit


@pytest.mark.parametrize("word", ["Newtons", "Kilopond", "Gramm", "Millivolt", "Digits", "counts"])
def test_a_spelled_unit_in_round_brackets_is_no_name(word):
    assert unit_in_header(f"F ({word})") == word


@pytest.mark.parametrize(
    ("header", "si_unit", "unit"),
    [
        ("Fz mN", "N", "mN"), ("roll_deg", "rad", "deg"), ("x_mm (left)", "m", "mm"),
        ("omega_leg_rad_s", "rad/s", "rad/s"), ("n_min", "rad/s", None), ("fz_min", "N", None),
        ("t_min", "s", "min"), ("speed_deg", "rad/s", "deg"), ("t", "s", None), ("mN", "N", None),
    ],
)  # fmt: skip
def test_an_ending_is_a_unit_where_it_fits_or_can_be_nothing_else(header, si_unit, unit):
    assert suffix_unit(header, si_unit) == unit
