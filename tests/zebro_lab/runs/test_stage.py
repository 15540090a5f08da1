# SPDX-License-Identifier: MIT
"""Runs are listed with how they ended and what they hold, those that cannot be read too."""

import pytest

from support.written_runs import edit, make_run
from zebro_lab.files.errors import NotFound
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.runs.exclusion import exclude_run, take_in_again
from zebro_lab.runs.stage import list_runs


def test_exclusions_are_listed_with_their_reasons(tmp_path):
    folder = make_run(tmp_path)
    states = []
    for change in (
        lambda: exclude_run(folder, why="belt"), lambda: exclude_run(folder, why="disc"),
        lambda: take_in_again(folder),
    ):  # fmt: skip
        change()
        states += [run.state for run in list_runs(tmp_path)]
    assert states == [
        "excluded (belt)", "excluded (disc; before: belt)", "completed (was excluded: disc; belt)"
    ]  # fmt: skip


def test_a_run_whose_recorder_died_is_listed_with_what_its_log_holds(tmp_path):
    folder = make_run(tmp_path, 200)
    edit(folder, exit_status="recording", stop=None, streams={})
    (run,) = list_runs(tmp_path)
    end = read_raw_log(folder / "log.mcap").streams["/board/raw"].host_time[-1]
    assert (run.state, run.duration, run.samples) == ("recovered", end, {"/board/raw": 200})


def test_a_run_that_cannot_be_read_does_not_hide_the_others(tmp_path):
    for label in "ab":
        make_run(tmp_path, label=label)
    bad, good = sorted(tmp_path.iterdir())
    (bad / "run.json").write_text("{")
    first, second = list_runs(tmp_path)
    assert first.name == bad.name
    assert first.state.startswith("unreadable: ")
    assert (second.name, second.state) == (good.name, "completed")
    with pytest.raises(NotFound, match=r"run\.json: is a file; give the folder"):
        list_runs(good / "run.json")
    with pytest.raises(NotFound, match="absent: no such folder"):
        list_runs(tmp_path / "absent")
