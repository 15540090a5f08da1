# SPDX-License-Identifier: MIT
"""Leg logs: however they are written the angles are the same, and no fault passes."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.walk.folder import write_path


def log(n: int = 200, rate: float = 100.0) -> pd.DataFrame:
    t = np.arange(n) / rate
    speeds = np.array([3.0, 3.2, 3.0, 3.2, 3.0, 3.2])
    starts = np.array([0.9, 2.3, 2.3, 0.8, 0.9, 2.3])
    theta = starts + t[:, None] * speeds
    return pd.DataFrame({"t": t, **{name: theta[:, i] for i, name in enumerate(ANGLES)}})


@pytest.fixture
def read(tmp_path):
    """Return a reader of a table, with the text of a columns.toml if given."""

    def reader(table: pd.DataFrame, mapping: str | None = None, **options):
        table.to_csv(tmp_path / "legs.csv", index=False)
        if mapping is not None:
            (tmp_path / "columns.toml").write_text(mapping)
        return read_leg_log(tmp_path / "legs.csv", **options)

    return reader


def test_canonical_log_is_taken_as_it_is(read):
    table = log()
    found = read(table)
    np.testing.assert_allclose(found.reference.t, table.t)
    np.testing.assert_allclose(found.reference.theta, table[list(ANGLES)])
    assert found.source == "unknown"
    assert "about 100 Hz" in found.notes[0]


@given(start=st.floats(-10, 10))
def test_wrapped_log_is_unwrapped(start, tmp_path_factory):
    table = log()
    angles = list(ANGLES)
    file = tmp_path_factory.mktemp("log") / "legs.csv"
    wrapped = (table[angles] + start) % (2 * np.pi)
    table.assign(**wrapped).to_csv(file, index=False)
    theta = read_leg_log(file).reference.theta
    growth = table[angles].to_numpy() - table[angles].to_numpy()[0]
    np.testing.assert_allclose(theta - theta[0], growth, atol=1e-9)


def test_other_names_units_and_signs_are_mapped(read):
    table = log()
    theirs = pd.DataFrame({
        "time_ms": table.t * 1000,
        **{f"leg {i}": -np.degrees(table[f"theta{i}"]) for i in range(1, 6)},
        "leg 6": (table.theta6 / (2 * np.pi) * 100) % 100,  # counts, 100 a turn
    })  # fmt: skip
    columns = 'source = "real"\n[columns]\nt = {name = "time_ms", unit = "ms"}\n'
    for i in range(1, 6):
        columns += f'theta{i} = {{name = "leg {i}", unit = "deg", sign = -1}}\n'
    columns += 'theta6 = {name = "leg 6", unit = "centiturn"}\n'
    found = read(theirs, columns)
    np.testing.assert_allclose(found.reference.t, table.t, atol=1e-12)
    np.testing.assert_allclose(found.reference.theta, table[list(ANGLES)], atol=1e-9)
    assert found.source == "real"
    assert [file.name for file in found.files] == ["legs.csv", "columns.toml"]


def test_signs_of_the_robot_are_applied(read):
    found = read(log(), leg_sign=(1, -1, 1, 1, 1, 1))
    np.testing.assert_allclose(found.reference.theta[:, 1], -log().theta2)
    assert "legs 2 turn backwards" in found.notes[-1]


def test_walked_path_is_a_leg_log(walked, tmp_path):
    write_path(tmp_path / "path.csv", walked)
    np.testing.assert_allclose(read_leg_log(tmp_path).reference.theta, walked.theta)


def without(name: str, row: int, value: float = np.nan):
    return lambda table: table.assign(**{name: table[name].where(table.index != row, value)})


FAULTS = {
    "missing leg": (lambda t: t.drop(columns="theta4"), "column 'theta4': missing, the angle of l"),
    "missing time": (lambda t: t.drop(columns="t"), "column 't': missing, the time"),
    "empty cell": (without("theta2", 7), "column 'theta2', row 8 (line 9): is empty"),
    "infinite angle": (without("theta5", 0, np.inf), "column 'theta5', row 1 (line 2): is infinit"),
    "reversed time": (lambda t: t.iloc[::-1], "column 't', row 2 (line 3): time goes from 1.99 to"),
    "repeated time": (without("t", 5, 0.04), "column 't', row 6 (line 7): time goes from 0.04 to"),
    "gap": (lambda t: t.drop(index=range(50, 60)), "column 't', row 51 (line 52): time jumps from"),
    "half a turn": (lambda t: t.iloc[::90], "column 'theta1', row 2 (line 3): leg 1 turns by 2.7"),
    "one row": (lambda t: t.head(1), "has 1 row; a leg log needs two or more"),
    "text": (lambda t: t.assign(theta1="x"), "column 'theta1', row 1 (line 2): 'x' is not a num"),
}  # fmt: skip


@pytest.mark.parametrize(("spoil", "message"), FAULTS.values(), ids=FAULTS)
def test_fault_is_one_line_that_names_file_column_and_row(spoil, message, read, tmp_path):
    with pytest.raises(DataError) as caught:
        read(spoil(log()))
    assert message in str(caught.value)
    assert str(tmp_path / "legs.csv") in str(caught.value)
    assert "\n" not in str(caught.value)


SETTINGS = {
    "no TOML": ("[columns", "cannot be read as TOML"),
    "unknown table": ("[legs]\n", "legs: unknown key"),
    "unknown column": ('[columns]\ntheta7 = "x"', "columns.theta7: unknown key; did you mean 'the"),
    "unknown key": ('[columns.t]\nnam = "x"', "columns.t.nam: unknown key; did you mean 'name'"),
    "frequency": ('[columns.theta1]\nunit = "Hz"', "columns.theta1.unit: unit 'Hz' cannot be conv"),
    "sign": ("[columns.theta1]\nsign = 0", "columns.theta1.sign: found 0; expected 1 or -1"),
    "a number": ("[columns]\nt = 1", "columns.t: found 1; expected a table"),
}  # fmt: skip


@pytest.mark.parametrize(("columns", "message"), SETTINGS.values(), ids=SETTINGS)
def test_fault_in_columns_toml_names_file_and_key(columns, message, read):
    with pytest.raises(SettingsError) as caught:
        read(log(), columns)
    assert message in str(caught.value)


def test_named_columns_file_must_exist(read, tmp_path):
    with pytest.raises(NotFound, match=r"expected a columns\.toml"):
        read(log(), columns=tmp_path / "none.toml")


def test_empty_folder_is_no_leg_log(tmp_path):
    with pytest.raises(DataError, match=r"is a folder without a path\.csv"):
        read_leg_log(tmp_path)


@pytest.mark.reference
def test_logs_of_the_virtual_world_are_read_by_their_names(shared, tmp_path):
    columns = tmp_path / "columns.toml"
    columns.write_text(
        'source = "sim:virtual-world"\n[columns]\n'
        + "".join(f'theta{leg} = "th{leg}"\n' for leg in range(1, 7))
    )
    for file in sorted((shared / "virtual-world" / "walks").glob("*.csv.gz")):
        found = read_leg_log(file, columns=columns)
        table = pd.read_csv(file)
        np.testing.assert_allclose(found.reference.theta, table[[f"th{i}" for i in range(1, 7)]])
