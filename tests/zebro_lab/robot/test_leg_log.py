# SPDX-License-Identifier: MIT
"""Leg angles of a table are unwrapped, short gaps are bridged, and no fault passes."""

import dataclasses
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from support.leg_motions import tripod
from support.leg_tables import leg_table
from zebro_lab.files.errors import DataError
from zebro_lab.robot.leg_log import ANGLES, LEG_UNITS, LegLog, bridged_gaps, legs_of_table
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file


def read(table: pd.DataFrame, folder: Path, **options) -> LegLog:
    table.to_csv(folder / "legs.csv", index=False)
    raw = read_table_file(folder / "legs.csv")
    return legs_of_table(raw, Columns(LEG_UNITS), files=[raw.path], **options)


def in_memory(table: pd.DataFrame) -> RawTable:
    return RawTable(Path("legs.csv"), {name: table[name] for name in table})


@given(start=st.floats(-10, 10))
def test_angles_wrapped_to_a_turn_are_unwrapped(start):
    table, angles = leg_table(), list(ANGLES)
    wrapped = table.assign(**(table[angles] + start) % (2 * np.pi))
    found = legs_of_table(in_memory(wrapped), Columns(LEG_UNITS), files=[Path("legs.csv")])
    growth = table[angles].to_numpy() - table[angles].to_numpy()[0]
    theta = found.reference.theta
    np.testing.assert_allclose(theta - theta[0], growth, atol=1e-9)


def test_signs_of_the_robots_legs_are_applied(tmp_path):
    found = read(leg_table(), tmp_path, leg_sign=(1, -1, 1, 1, 1, 1))
    np.testing.assert_allclose(found.reference.theta[:, 1], -leg_table().theta2)
    assert found.notes == ("leg log: 200 samples over 1.99 s, about 100 Hz",)


def test_the_source_of_the_table_is_kept_and_unknown_without_one():
    for source, expected in (("sim:zebro", "sim:zebro"), (None, "unknown")):
        raw = dataclasses.replace(in_memory(leg_table()), source=source)
        found = legs_of_table(raw, Columns(LEG_UNITS), files=[raw.path])
        assert (found.source, found.files) == (expected, (raw.path,))


def without(name: str, row: int, value: float = np.nan):
    return lambda table: table.assign(**{name: table[name].where(table.index != row, value)})


FAULTS = {
    "missing leg": (lambda t: t.drop(columns="theta4"), "column 'theta4': the column of the angle"),
    "empty cell": (without("theta2", 7), "column 'theta2', row 8 (line 9): is empty"),
    "reversed time": (lambda t: t.iloc[::-1], "column 't', row 2 (line 3): time goes from 1.99 to"),
    "gap": (lambda t: t.drop(index=range(50, 80)), "column 't', row 51 (line 52): time jumps from"),
    "half a turn": (lambda t: t.iloc[::90], "column 'theta1', row 2 (line 3): leg 1 turns by 2.7"),
    "one row": (lambda t: t.head(1), "has 1 row; expected two or more rows"),
}  # fmt: skip


@pytest.mark.parametrize(("spoil", "message"), FAULTS.values(), ids=FAULTS)
def test_fault_is_one_line_that_names_file_column_and_row(spoil, message, tmp_path):
    with pytest.raises(DataError) as caught:
        read(spoil(leg_table()), tmp_path)
    assert message in str(caught.value)
    assert str(tmp_path / "legs.csv") in str(caught.value)
    assert "\n" not in str(caught.value)


def test_wrapped_angles_are_unwrapped_only_where_a_step_is_short(tmp_path):
    """A step of 3.6 rad forward and one of 2.7 rad back are the same between wrapped angles."""
    table, angles = leg_table(rate=10.0), list(ANGLES)
    assert read(table.assign(**4.0 * table[angles]), tmp_path)  # 1.3 rad a sample
    wrapped = table.assign(**(5.5 * table[angles]) % (2 * np.pi))  # 1.76 rad
    with pytest.raises(DataError, match=r"at most 1\.57 rad, or a jump by one turn"):
        read(wrapped, tmp_path)
    assert read(table.assign(**5.5 * table[angles]), tmp_path)  # not wrapped: up to 2.5 rad


def test_angles_that_jump_by_more_than_a_turn_are_in_another_unit(tmp_path):
    """Degrees wrapped at 360 that are read as radians are refused, not folded."""
    table, angles = leg_table(rate=1000.0), list(ANGLES)
    degrees = table.assign(**np.degrees(6.0 * table[angles]) % 360)
    with pytest.raises(
        DataError, match=r"leg \d turns by 3[56]\d rad .*are they degrees or counts"
    ):
        read(degrees, tmp_path)


@pytest.mark.parametrize(("factor", "unit"), [(1e3, "ms"), (1e9, "ms"), (1 / 3600, "min")])
def test_times_of_another_unit_are_asked_for(tmp_path, factor, unit):
    table = leg_table()
    other = table.assign(t=factor * table.t)
    with pytest.raises(DataError, match=rf"column 't'.* s apart.*\[columns.t\] unit = \"{unit}\""):
        read(other, tmp_path)


T = np.arange(0.0, 6.0, 0.01)
STEADY = leg_table(len(T)).drop(columns="t").to_numpy()
COUNT = 2 * np.pi / 100


def lacking(first, last, theta=STEADY):
    """Return times and angles without samples `first` to `last`."""
    kept = np.r_[0:first, last + 1 : len(T)]
    return T[kept], theta[kept]


def bridged(t, theta):
    return bridged_gaps(RawTable(Path("legs.csv"), {}), "t", t, theta, advice="cut it")


@pytest.mark.parametrize("theta", [STEADY, COUNT * np.round(STEADY / COUNT)])
def test_a_short_gap_of_steady_legs_is_bridged_and_told(theta):
    (note,) = bridged(*lacking(100, 110, theta))
    assert note.startswith("WARNING: leg log: no samples from 0.99 to 1.11 s; every leg keeps its")


def test_no_gap_gives_no_note():
    assert bridged(T, STEADY) == ()
    assert bridged(*lacking(100, 103)) == ()


def test_what_is_bridged_is_near_the_truth_wherever_the_gap_lies_in_a_gait():
    theta = tripod().angles(T)
    refused = 0
    for first in range(30, 260, 3):
        t, seen = lacking(first, first + 9, theta)
        try:
            bridged(t, seen)
        except DataError as error:
            assert "changes its speed in that time" in str(error)  # noqa: PT017 - it may pass, too
            refused += 1
            continue
        lost = slice(first, first + 10)
        lines = np.column_stack([np.interp(T[lost], t, leg) for leg in seen.T])
        assert np.abs(lines - theta[lost]).max() < 0.15
    assert 10 < refused < 70


@pytest.mark.parametrize(
    ("gap", "why"),
    [
        ((100, 130), "that is 0.32 s"),
        ((2, 12), "too few samples beside it"),
        ((586, 597), "too few samples beside it"),
    ],
)
def test_a_gap_that_says_too_little_is_refused_with_the_advice(gap, why):
    with pytest.raises(DataError, match=rf"time jumps from .*{why}.*: cut it") as refused:
        bridged(*lacking(*gap))
    assert refused.value.row == gap[0] + 1


def test_gaps_near_each_other_are_refused():
    lost = np.r_[100:111, 114:120]
    t, theta = np.delete(T, lost), np.delete(STEADY, lost, axis=0)
    with pytest.raises(DataError, match="another gap is too near"):
        bridged(t, theta)


def test_the_leg_that_changes_its_speed_is_named():
    theta = STEADY.copy()
    theta[105:, 3] += 5.0 * (T[105:] - T[105])
    with pytest.raises(DataError, match="leg 4 changes its speed in that time"):
        bridged(*lacking(100, 110, theta))
