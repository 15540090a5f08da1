# SPDX-License-Identifier: MIT
"""Rows are assigned to runs by a column, by pauses, or one by one."""

import numpy as np
import pandas as pd
import pytest

from support.rig_tables import N, columns, given_slip, write
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import DataError


def test_run_column_and_by_separate_the_same_runs(tmp_path):
    by_column = write(tmp_path / "1", given_slip().assign(run=np.repeat([3, 1, 3, 2], N // 4)))
    by_rule = write(tmp_path / "2", given_slip().assign(set=np.repeat([3, 1, 3, 2], N // 4)))
    columns(by_rule.parent, "runs.by = 'set'")
    first, second = read_rig_data([by_column]).samples, read_rig_data([by_rule]).samples
    np.testing.assert_array_equal(first.run, second.run)
    assert first.run_names == ("rig run=3", "rig run=1", "rig run=3 (2)", "rig run=2")
    assert second.run_names[0] == "rig set=3"


def test_pause_separates_runs_and_left_out_rows_do_not(tmp_path):
    table = given_slip()
    table.loc[20:, "t"] += 2.0
    table["warm"] = 1
    table.loc[5:10, "warm"] = 0
    columns(tmp_path, "runs.gap = '0.01 s'\nrows.keep = ['warm == 1']")
    data = read_rig_data([write(tmp_path, table)])
    assert data.samples.run_names == ("rig run 1", "rig run 2")
    assert data.samples.run.tolist() == [0] * 14 + [1] * 20
    assert "6 of 40 rows left out; kept where warm == 1" in data.notes


def test_each_row_is_a_trial_without_time(tmp_path):
    columns(tmp_path, "runs.each_row = true")
    data = read_rig_data([write(tmp_path, given_slip().head(12))])
    assert data.samples.n_runs == len(data.samples) == 12
    assert data.samples.time is None


def test_time_increases_within_a_run_and_may_restart_with_another(tmp_path):
    table, message = given_slip(), "time goes back to 0 s; .* if a new run begins here"
    table.loc[5, "t"] = 0.0
    path = write(tmp_path, table.assign(trial=np.where(table.index < 5, "a", "b")))
    with pytest.raises(DataError, match=message) as raised:
        read_rig_data([path])
    assert (raised.value.column, raised.value.row, raised.value.line) == ("t", 6, 7)
    columns(tmp_path, "runs.by = 'trial'")
    samples = read_rig_data([path]).samples
    assert samples.run_names == ("rig trial=a", "rig trial=b")
    np.testing.assert_array_equal(samples.time[4:6], [0.016, 0.0])


@pytest.mark.parametrize("rate", [1300, 2000])
def test_times_that_rounding_made_equal_are_those_of_even_spacing(tmp_path, rate):
    table = pd.concat([given_slip().assign(run=run) for run in (1, 2)], ignore_index=True)
    t = np.arange(len(table)) / rate
    data = read_rig_data([write(tmp_path, table.assign(t=np.round(t, 3)))])
    np.testing.assert_allclose(np.diff(data.samples.time[:N]), 1 / rate, rtol=0.05)
    np.testing.assert_allclose(data.samples.time, t, atol=1e-3)
    (note,) = (note for note in data.notes if "times repeat" in note)
    assert note.endswith("as if rounded; the even spacing that this hides is taken")


def test_times_that_repeat_otherwise_are_not_used(tmp_path):
    table = given_slip().assign(t=np.repeat([0.0, 0.01, 0.02, 0.5], N // 4))
    data = read_rig_data([write(tmp_path, table)])
    assert data.samples.time is None
    assert any("36 times repeat" in note and "not used" in note for note in data.notes)


def test_runs_are_left_out_by_number(tmp_path):
    columns(tmp_path, "[runs]\neach_row = true\nleave_out = [2, 12]")
    table = given_slip().assign(run=np.repeat([3, 5, 7, 9], N // 4))
    table.loc[11, "traction_force"] = np.nan  # left out before it is read
    data = read_rig_data([write(tmp_path, table)])
    rows = [row for row in range(1, N + 1) if row not in (2, 12)]
    assert data.samples.run_names == tuple(f"rig row {row}" for row in rows)
    assert "rig.csv: rows 2, 12 are left out" in data.notes
    columns(tmp_path, "runs.leave_out = [1, 2]")
    assert read_rig_data([tmp_path / "rig.csv"]).samples.run_names == ("rig run=7", "rig run=9")
    columns(tmp_path, "runs.leave_out = [5]")
    with pytest.raises(DataError, match=r"leave_out in .* names runs 5; expected some of 1 to 4"):
        read_rig_data([tmp_path / "rig.csv"])


def test_times_that_are_no_seconds_are_asked_about_and_pauses_between_runs_are_not(tmp_path):
    table = given_slip().assign(t=np.arange(N) * 5.0, run=np.repeat([1, 2], N // 2))
    with pytest.raises(
        DataError, match=r"'t': samples are 5 s apart.*\[columns\.t\] unit = \"ms\""
    ):
        read_rig_data([write(tmp_path / "1", table)])
    paused = table.assign(t=np.arange(N) * 0.1 + 1e6 * table.run)
    assert read_rig_data([write(tmp_path / "2", paused)]).samples.n_runs == 2
    columns(write(tmp_path / "3", table).parent, "columns.t.unit = 's'")
    assert read_rig_data([tmp_path / "3" / "rig.csv"]).samples.time is not None
