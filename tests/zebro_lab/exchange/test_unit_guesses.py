# SPDX-License-Identifier: MIT
"""A unit is sure where the file states one that fits, and in doubt otherwise."""

from pathlib import Path

import pandas as pd
import pytest

from zebro_lab.exchange.unit_guesses import guess_unit
from zebro_lab.tables.raw_table import RawTable


def guess(si_unit, cells, *, stated=None, name="x", si=False):
    units = {} if stated is None else {name: stated}
    table = RawTable(Path("a.csv"), {name: pd.Series(cells)}, units=units)
    found = guess_unit(table, name, si_unit, si=si)
    return found.unit + "?" * bool(found.doubt)


@pytest.mark.parametrize(
    ("si_unit", "stated", "unit"),
    [
        ("s", "ms", "ms"), ("N", "kN", "kN"), ("rad", "°", "°"), ("m/s^2", "g", "g"),
        ("N", "kg", "kgf?"), ("rad/s", "1/min", "1/min"), ("rad/s", "Hz", "rev/s?"),
        ("rad", "grad", "deg?"), ("N", "V", "N?"), ("s", "Frame", "s?"),
    ],
)  # fmt: skip
def test_what_the_file_states_is_sure_if_it_fits(si_unit, stated, unit):
    assert guess(si_unit, [1.0, 2.0], stated=stated) == unit


@pytest.mark.parametrize(
    ("si_unit", "cells", "unit"),
    [
        ("dimensionless", [0.1, 0.9], "dimensionless?"), ("dimensionless", [5.0, 90.0], "%?"),
        ("rad", [0.0, 6.2], "rad?"), ("rad", [0.0, 359.0], "deg?"), ("s", [1.7e18], "ns?"),
        ("s", ["12:00:00", "12:00:01"], "h:m:s"), ("N", ["a"], "N?"),
        ("s", pd.to_datetime(["2026-03-04"]), "date UTC?"),
        ("s", pd.to_datetime(["2026-03-04T00:00Z"]), "date"),
    ],
)  # fmt: skip
def test_without_a_statement_the_numbers_suggest_one(si_unit, cells, unit):
    assert guess(si_unit, cells) == unit


def test_a_name_in_si_is_sure_unless_the_file_states_otherwise():
    assert guess("s", [1.0], si=True) == "s"
    assert guess("s", [1.0], si=True, stated="ms") == "ms"
