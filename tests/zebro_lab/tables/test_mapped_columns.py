# SPDX-License-Identifier: MIT
"""Columns of a time series are found under other names, in SI with the canonical sign."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.mapped_columns import (
    canonical_columns,
    parse_mapped_columns,
    read_mapped_columns,
)
from zebro_lab.tables.raw_table import RawTable

UNITS = {"t": "s", "roll": "rad"}
READ = {"what": "roll of the body", "advice": "delete such rows"}


def table(**columns) -> RawTable:
    return RawTable(Path("imu.csv"), {name: pd.Series(each) for name, each in columns.items()})


def parse(**content):
    return parse_mapped_columns(SettingsTable(content, file="columns.toml", path="imu"), UNITS)


def test_names_units_and_signs_of_the_map_are_applied_and_others_stay():
    found = parse(source="real", columns={"roll": {"name": "R", "unit": "deg", "sign": -1}})
    raw = table(t=[0.0, 1.0], R=[90.0, -180.0])
    np.testing.assert_allclose(found.numbers(raw, "roll", **READ), [-np.pi / 2, np.pi])
    np.testing.assert_array_equal(found.numbers(raw, "t", **READ), [0.0, 1.0])
    assert (found.source, found.file) == ("real", Path("columns.toml"))
    assert found.has(raw, "roll")
    assert not canonical_columns(UNITS).has(raw, "roll")


def test_another_header_keeps_the_unit():
    found = parse(columns={"roll": {"unit": "deg"}}).called("roll", "phi")
    np.testing.assert_allclose(found.numbers(table(phi=[180.0]), "roll", **READ), [np.pi])


def test_a_missing_column_says_where_to_map_it():
    with pytest.raises(DataError, match=r"'roll': the column of the roll of the body is "
                       r"missing; .*'rol'.*map it in "
                       r"columns\.toml: \[imu\.columns\.roll\]"):  # fmt: skip
        parse().numbers(table(rol=[1.0]), "roll", **READ)


def test_frames_are_a_time_once_their_rate_is_stated():
    with pytest.raises(DataError, match=r'frames at 100 Hz: name = "Frame", unit = "s", scale'):
        parse().numbers(table(Frame=[1, 2], x=[0, 0]), "t", what="time", advice="")
    at_50_hz = parse(columns={"t": {"name": "Frame", "unit": "s", "scale": 0.02}})
    found = at_50_hz.numbers(table(Frame=[1, 2]), "t", what="time", advice="")
    np.testing.assert_allclose(found, [0.02, 0.04])


@pytest.mark.parametrize(("cell", "found"), [(np.nan, "empty"), (-np.inf, "infinite")])
def test_a_cell_without_a_finite_number_is_named(cell, found):
    message = f"row 2: is {found}; expected a number in rad: delete such rows"
    with pytest.raises(DataError, match=message):
        parse().numbers(table(roll=[1.0, cell]), "roll", **READ)


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
    legs, topic = read_mapped_columns("legs", table, None, {"theta1": "rad"})
    assert (legs.mapped["theta1"].name, legs.source, topic) == ("fl", "sim:x", "/joints")
    imu, topic = read_mapped_columns("imu", table, None, {"roll": "rad"})
    assert (imu.mapped["roll"].name, imu.file, topic) == ("R", tmp_path / "columns.toml", None)
    other = tmp_path / "other.toml"
    other.write_text('[imu.columns]\nroll = "theirs"')
    assert read_mapped_columns("imu", table, other, {"roll": "rad"})[0].mapped["roll"].name == (
        "theirs"
    )


def test_without_a_file_names_are_canonical(tmp_path):
    found, topic = read_mapped_columns("imu", tmp_path / "a.csv", None, {"roll": "rad"})
    assert (found.mapped["roll"].name, found.where, topic) == ("roll", "imu.", None)
