# SPDX-License-Identifier: MIT
"""Units as people write them."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from zebro_lab.files.errors import UnitError
from zebro_lab.files.units import factor_to_si, is_unit_of, quantity_to_si


@pytest.mark.parametrize(
    ("unit", "si_unit", "factor"),
    [
        ("mm", "m", 1e-3),
        ("kN", "N", 1e3),
        ("rpm", "rad/s", 2 * math.pi / 60),
        ("tr/min", "rad/s", 2 * math.pi / 60),
        ("rev/s", "rad/s", 2 * math.pi),
        ("1/min", "rad/s", 2 * math.pi / 60), ("min⁻¹", "rad/s", 2 * math.pi / 60),
        ("Upm", "rad/s", 2 * math.pi / 60), ("cN", "N", 0.01), ("MN", "N", 1e6),
        ("dyn", "N", 1e-5), ("p", "N", 9.80665e-3), ("kp", "N", 9.80665),
        ("dps", "rad/s", math.pi / 180),
        ("mdps", "rad/s", math.pi / 180e3),
        ("g", "m/s^2", 9.80665),
        ("mg", "m/s^2", 9.80665e-3),
        ("deg/s", "rad/s", math.pi / 180),
        ("%", "dimensionless", 0.01),
        ("-", "dimensionless", 1.0),
        ("", "dimensionless", 1.0),
    ],
)  # fmt: skip
def test_factor_takes_a_unit_to_si(unit, si_unit, factor):
    assert factor_to_si(unit, si_unit) == pytest.approx(factor, rel=1e-12)


@pytest.mark.parametrize(
    ("unit", "si_unit"),
    [
        ("mm", "N"),
        ("kg", "N"),
        ("Hz", "rad/s"),
        ("1/s", "rad/s"),
        ("mg", "N"),
        ("rad", "dimensionless"),
    ],
)
def test_unit_of_another_dimension_is_refused(unit, si_unit):
    with pytest.raises(UnitError, match="cannot be converted"):
        factor_to_si(unit, si_unit)


def test_unknown_unit_names_the_nearest():
    with pytest.raises(UnitError, match="did you mean 'rpm'"):
        factor_to_si("rpmm", "rad/s")


@settings(deadline=None)
@given(st.text(max_size=12))
def test_any_text_is_a_unit_or_a_unit_error(text):
    assert is_unit_of(text, "N") in (True, False)


@given(st.floats(allow_nan=False, allow_infinity=False, width=32))
def test_quantity_with_unit_round_trips(number):
    assert quantity_to_si(f"{number!r} mm", "m") == pytest.approx(number * 1e-3, rel=1e-12)
    assert quantity_to_si(number, "m") == number


@pytest.mark.parametrize("text", ["", "mm", "1,5 mm", "nan", "1e999 m", float("nan")])
def test_what_is_no_quantity_is_refused(text):
    with pytest.raises(UnitError):
        quantity_to_si(text, "m")


@pytest.mark.timeout(20)
@pytest.mark.parametrize(
    "unit",
    [
        "9**9**9 mm", "9^9^9", "mm**9**9**9", "((9**9)**9)**9)**9", "(9)**(99999999)",
        "9⁹⁹⁹⁹⁹⁹⁹ mm",
        "(1+1)**99**99", "((1-1-1-1)**99)**99", "mm**999999999", "mm " * 100_000, "a" * 59 + "!",
        "((1_000**99)**99)**99",
    ],
    ids=lambda unit: unit[:20],
)  # fmt: skip
def test_a_unit_that_would_be_multiplied_out_for_ever_is_an_unknown_one(unit):
    with pytest.raises(UnitError, match="unknown unit") as raised:
        factor_to_si(unit, "m")
    assert len(str(raised.value)) < 300
    with pytest.raises(UnitError):
        quantity_to_si(f"9 {unit}", "m")


@pytest.mark.parametrize(
    ("unit", "si_unit", "factor"),
    [
        ("m^-1", "1/m", 1.0), ("m**2", "m^2", 1.0), ("1/(mm*s)", "1/(m*s)", 1e3),
        ("m·s⁻¹", "m/s", 1.0), ("µm", "m", 1e-6), ("km/h", "m/s", 1 / 3.6), ("m/s2", "m/s^2", 1.0),
        ("mm ^ 2", "m^2", 1e-6),
    ],
)  # fmt: skip
def test_products_and_powers_are_units(unit, si_unit, factor):
    assert factor_to_si(unit, si_unit) == pytest.approx(factor, rel=1e-12)
