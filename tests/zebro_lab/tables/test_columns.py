# SPDX-License-Identifier: MIT
"""Columns are found under other names, in SI with the canonical sign, by map or file."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.robot.imu_log import IMU_UNITS
from zebro_lab.robot.leg_log import LEG_UNITS
from zebro_lab.tables.columns import Columns, MappedColumn, looks_like_other
from zebro_lab.tables.columns_file import parse_mapped_columns, read_mapped_columns
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_columns import CANONICAL
from zebro_lab.track.trajectory.table import MAPPED_UNITS


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


UNITS = {"t": "s", "roll": "rad"}
READ = {"what": "roll of the body", "advice": "delete such rows"}


def parse(**content):
    return parse_mapped_columns(SettingsTable(content, file="columns.toml", path="imu"), UNITS)


def test_names_units_and_signs_of_the_map_are_applied_and_others_stay():
    found = parse(source="real", columns={"roll": {"name": "R", "unit": "deg", "sign": -1}})
    raw = table({}, t=[0.0, 1.0], R=[90.0, -180.0])
    np.testing.assert_allclose(found.numbers(raw, "roll", **READ), [-np.pi / 2, np.pi])
    np.testing.assert_array_equal(found.numbers(raw, "t", **READ), [0.0, 1.0])
    assert (found.source, found.file) == ("real", Path("columns.toml"))
    assert found.has(raw, "roll")
    assert not Columns(UNITS).has(raw, "roll")


def test_a_missing_column_says_where_to_map_it():
    with pytest.raises(DataError, match=r"'roll': the column of the roll of the body is "
                       r"missing; .*'rol'.*map it in "
                       r"columns\.toml: \[imu\.columns\.roll\]"):  # fmt: skip
        parse().numbers(table({}, rol=[1.0]), "roll", **READ)


def test_frames_are_a_time_once_their_rate_is_stated():
    with pytest.raises(DataError, match=r'frames at 100 Hz: name = "Frame", unit = "s", scale'):
        parse().numbers(table({}, Frame=[1, 2], x=[0, 0]), "t", what="time", advice="")
    at_50_hz = parse(columns={"t": {"name": "Frame", "unit": "s", "scale": 0.02}})
    found = at_50_hz.numbers(table({}, Frame=[1, 2]), "t", what="time", advice="")
    np.testing.assert_allclose(found, [0.02, 0.04])


@pytest.mark.parametrize(("cell", "found"), [(np.nan, "empty"), (-np.inf, "infinite")])
def test_a_cell_without_a_finite_number_is_named(cell, found):
    message = f"row 2: is {found}; expected a number in rad: delete such rows"
    with pytest.raises(DataError, match=message):
        parse().numbers(table({}, roll=[1.0, cell]), "roll", **READ)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ({"sources": "real"}, "imu.sources: unknown key; did you mean 'source'"),
        ({"columns": {"yaw": {}}}, "imu.columns.yaw: unknown key"),
        ({"columns": {"roll": {"unit": "m"}}}, "unit 'm' cannot be converted to rad"),
    ],
)
def test_a_fault_of_the_map_names_its_key(content, message):
    with pytest.raises(SettingsError, match=message):
        parse(**content)


SECTIONS = """
source = "sim:x"
[legs]
topic = "/joints"
columns.theta1 = {name = "fl", unit = "deg"}
[imu.columns]
roll = "R"
"""


def test_each_kind_of_table_has_its_section_and_the_common_source(tmp_path):
    (tmp_path / "columns.toml").write_text(SECTIONS)
    table = tmp_path / "table.csv"
    table.touch()
    legs, topic = read_mapped_columns("legs", table, None, {"theta1": "rad"})
    assert (legs.mapped["theta1"].name, legs.source, topic) == ("fl", "sim:x", "/joints")
    imu, topic = read_mapped_columns("imu", table, None, {"roll": "rad"})
    assert (imu.mapped["roll"].name, imu.file, topic) == ("R", tmp_path / "columns.toml", None)
    other = tmp_path / "other.toml"
    other.write_text('[imu.columns]\nroll = "theirs"')
    assert read_mapped_columns("imu", table, other, {"roll": "rad"})[0].mapped["roll"].name == (
        "theirs"
    )


MAPS = {"rig": CANONICAL, "legs": LEG_UNITS, "track": MAPPED_UNITS, "imu": IMU_UNITS}
TABLES = {
    "rig": (["t", "slip_ratio", "Normal_Force", "Traction_Force"], "calibrate-slip"),
    "legs": (["t", *(f"theta{leg}" for leg in range(1, 7))], "zebro-lab predict"),
    "track": (["t_s", "x_m", "y_m", "qw", "qx", "qy", "qz"], "import --track"),
    "imu": (["t", "roll", "pitch", "yaw_rate"], "as --imu"),
}


@pytest.mark.parametrize("kind", TABLES)
@pytest.mark.parametrize("expected", MAPS)
def test_a_table_of_another_kind_is_told_with_what_takes_it(kind, expected):
    headers, taker = TABLES[kind]
    said = looks_like_other(headers, MAPS[expected])
    assert said == "" if kind == expected else taker in said


def test_a_table_that_may_be_anything_is_not_called_one_of_a_kind():
    assert looks_like_other(["t", "ch1", "ch2", "theta1"], CANONICAL) == ""
