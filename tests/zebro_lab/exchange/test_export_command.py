# SPDX-License-Identifier: MIT
"""`zebro-lab export` names every file that it writes."""

import re

from support.recorders import being_recorded
from support.written_runs import edit, make_run


def test_every_table_is_named(tmp_path, run_command):
    out = tmp_path / "out"
    ended = run_command("export", make_run(tmp_path), "--out", out)
    assert (ended.code, ended.err) == (0, "")
    assert sorted(ended.out.splitlines()) == sorted(f"wrote {file}" for file in out.iterdir())


def test_a_run_that_did_not_end_is_exported_with_its_state(tmp_path, run_command):
    folder = make_run(tmp_path)
    edit(folder, exit_status="recording")
    ended = run_command("export", folder, "--out", tmp_path / "out")
    said = r"WARNING: the run has not ended, state 'recovered'; .* to (.*) s"
    end = float(re.match(said, ended.out)[1])
    assert f"  recovered  {end:.1f} s  " in run_command("runs", tmp_path).out
    with being_recorded(folder):
        ended = run_command("export", folder, "--out", tmp_path / "now")
    assert ended.out.startswith("WARNING: the run has not ended, state 'recording'")
    edit(folder, exit_status="completed")
    assert "WARNING" not in run_command("export", folder, "--out", tmp_path / "more").out
