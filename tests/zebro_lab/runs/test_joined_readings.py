# SPDX-License-Identifier: MIT
"""Messages of some legs each become rows of all legs, interpolated, and no gap is bridged."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.files.errors import DataError
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.runs.joined_readings import joined_readings
from zebro_lab.tables.raw_table import RawTable

SPEED = 3.0  # rad/s


def messages(rate=100.0, lag=0.0015, seconds=3.0, group=1, turn=None, speed=SPEED):
    """Return a table with a message for each `group` of legs, `lag` s after the one before."""
    rows = []
    for t in np.arange(0, seconds, 1 / rate):
        for first in range(0, 6, group):
            at = t + lag * (first // group)
            angle = speed * at if turn is None else (speed * at) % turn
            rows.append({"t": at, **dict.fromkeys(ANGLES[first : first + group], angle)})
    return pd.DataFrame(rows, columns=["t", *ANGLES])


def joined(frame, turn=2 * np.pi):
    columns = {name: frame[name].reset_index(drop=True) for name in frame}
    return joined_readings(RawTable(Path("bag.mcap"), columns), dict.fromkeys(ANGLES, turn))


@pytest.mark.parametrize("group", [1, 2, 3])
def test_every_leg_is_where_it_was_at_the_time_of_the_row(group):
    table = joined(messages(group=group))
    t = table.columns["t"].to_numpy()
    assert len(t) == 299  # the first time of the first leg is before all others
    for name in ANGLES:
        np.testing.assert_allclose(table.columns[name], SPEED * t, atol=1e-12)
    (note,) = table.notes
    assert "joined at the 299 times of theta1, the other legs interpolated" in note


@pytest.mark.parametrize("turn", [2 * np.pi, 360.0])
def test_wrapped_legs_are_not_interpolated_across_a_turn(turn):
    speed = SPEED * turn / (2 * np.pi)
    table = joined(messages(turn=turn, speed=speed), turn=turn)
    t = table.columns["t"].to_numpy()
    for name in ANGLES:
        np.testing.assert_allclose(np.unwrap(table.columns[name], period=turn), speed * t)


def test_a_wrapped_leg_whose_direction_is_ambiguous_is_refused():
    with pytest.raises(DataError, match="theta1 turns by more than a quarter between two"):
        joined(messages(rate=5.0, turn=2 * np.pi, speed=9.0))


def test_rows_have_the_times_of_the_leg_with_the_fewest_readings():
    frame = messages()
    fewer = frame[frame.theta4.isna() | (frame.index // 6 % 2 == 1)]
    table = joined(fewer)
    seen = fewer.t[fewer.theta4.notna()]
    np.testing.assert_allclose(table.columns["t"], seen[:-1])  # the last is after other legs' last
    np.testing.assert_allclose(table.columns["theta2"], SPEED * table.columns["t"])


def test_nothing_is_extrapolated():
    frame = messages()
    late = frame[frame.theta2.isna() | ((frame.t > 1.0) & (frame.t < 2.0))]
    t = joined(late).columns["t"].to_numpy()
    seen = late.t[late.theta2.notna()]
    assert seen.min() <= t[0] < t[-1] <= seen.max()


def test_a_gap_of_one_leg_is_refused_with_its_place():
    frame = messages()
    silent = frame[frame.theta3.isna() | (frame.t < 0.5) | (frame.t > 0.6)]
    expected = r"theta3 has no reading for 0\.11 s, from 0\.49\d s after its first; expected .* cut"
    with pytest.raises(DataError, match=expected):
        joined(silent)


def test_stamps_that_go_back_are_refused():
    frame = messages()
    frame.loc[61, "t"] -= 0.5
    with pytest.raises(DataError, match="the stamps of theta2 do not increase"):
        joined(frame)


def test_a_table_with_a_row_of_all_legs_is_left_as_it_is():
    frame = messages(group=6)
    frame.loc[5, "theta3"] = np.nan
    table = joined(frame)
    assert len(table.columns["t"]) == len(frame)
    assert np.isnan(table.columns["theta3"][5])
