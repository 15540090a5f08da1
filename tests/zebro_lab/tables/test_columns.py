# SPDX-License-Identifier: MIT
"""A mapped column has the unit that the file states, where its map states none."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.files.errors import DataError
from zebro_lab.tables.columns import MappedColumn
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable


def table(units: dict[str, str], **columns) -> RawTable:
    return RawTable(Path("a.csv"), {n: pd.Series(c) for n, c in columns.items()}, units=units)


def test_the_unit_of_the_file_holds_where_the_map_states_none():
    raw = table({"F": "kN"}, F=[1.0, 2.0])
    column = MappedColumn("F", "N", -1.0)
    assert column.in_unit_of(raw, "N") == MappedColumn("F", "kN", -1e3)
    np.testing.assert_array_equal(column.in_unit_of(raw, "N").in_si(raw), [-1e3, -2e3])
    stated = MappedColumn("F", "N", 1.0, unit_stated=True)
    assert stated.in_unit_of(raw, "N") is stated
    with pytest.raises(DataError, match=r"column 'F': the file states its unit: .*'kN' cannot be"):
        column.in_unit_of(raw, "s")


@pytest.mark.parametrize(
    ("header", "si_unit", "factor"),
    [
        ("Normalkraft [daN]", "N", 10.0), ("Fz (cN)", "N", 0.01), ("F / gf", "N", 9.80665e-3),
        ("Fz [N] (2)", "N", 1.0), ("Fz [kN] (left)", "N", 1e3), ("F (Kraftaufnehmer 2)", "N", 1.0),
        ("FT_mN", "N", 1e-3), ("FT_MN", "N", 1e6), ("gx_dps", "rad/s", np.pi / 180),
        ("az_g", "m/s^2", 9.80665), ("omega_g", "rad/s", 1.0), ("position[1]", "rad", 1.0),
        ("theta [front]", "rad", 1.0), ("Fz (x)", "N", 1.0), ("Drehzahl Rad", "rad/s", 1.0),
        ("f_n", "N", 1.0), ("n_Bein [1/min]", "rad/s", np.pi / 30), ("x (left)", "m", 1.0),
        ("t_ms", "s", 1e-3), ("F [ ]", "N", 1.0), ("Time_ms_", "s", 1e-3),
    ],
)  # fmt: skip
def test_a_column_mapped_by_name_alone_has_the_unit_of_its_header(header, si_unit, factor):
    raw = table({header: unit} if (unit := unit_in_header(header)) else {}, **{header: [3.0]})
    column = MappedColumn(header, si_unit).in_unit_of(raw, si_unit)
    assert column.in_si(raw)[0] == pytest.approx(3.0 * factor, rel=1e-12)


@pytest.mark.parametrize(
    ("header", "found"),
    [
        ("Fz [N*10]", "'N*10' in the header is no unit that is known"),
        ("Fz [kN/10]", "'kN/10' in the header is no unit"), ("Fz (10N)", "'10N' in the header"),
        ("Fz / 10N", "'10N' in the header"), ("F [Zugkraft]", "'Zugkraft' in the header"),
        ("Fz (10^3 N)", "is no unit that is known"), ("Fz [foot]", "'foot' in the header"),
        ("Fz [kilopounds]", "'kilopounds' in the header"), ("Fz (Zehntelnewton)", "is no unit"),
        ("Fz [V]", "unit 'V' cannot be converted to N"), ("Fz_kg", "unit 'kg' cannot be converted"),
        ("Fz_g", "unit 'g' cannot be converted to N"), ("Fz [g]", "unit 'g' cannot be converted"),
        ("Fz_mV", "unit 'mV' cannot be converted to N"), ("Fz [grad]", "may be degrees or grad"),
    ],
)  # fmt: skip
def test_a_header_with_another_unit_is_refused_until_one_is_stated(header, found):
    raw = table({header: unit} if (unit := unit_in_header(header)) else {}, **{header: [3.0]})
    with pytest.raises(DataError) as raised:
        MappedColumn(header, "N").in_unit_of(raw, "N")
    assert found in str(raised.value)
    assert 'or scale = NUMBER, unit = "N" if 1 in the file is NUMBER N' in str(raised.value)
    stated = MappedColumn(header, "N", 0.5, unit_stated=True)
    assert stated.in_unit_of(raw, "N") is stated
