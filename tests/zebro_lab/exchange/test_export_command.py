# SPDX-License-Identifier: MIT
"""`zebro-lab export` names every file that it writes."""

import os
import re
from pathlib import Path

import pytest

from support.written_runs import edit, make_run
from zebro_lab.exchange import export_mcap_stage
from zebro_lab.exchange.export_mcap_stage import Exported


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_every_table_is_named(tmp_path, run_command, form):
    out = tmp_path / "out"
    ended = run_command("export", make_run(tmp_path), "--out", out, "--to", form)
    assert (ended.code, ended.err) == (0, "")
    files = sorted(f"wrote {file}" for file in out.iterdir() if file.suffix == f".{form}")
    assert len(files) == 2
    assert sorted(line for line in ended.out.splitlines() if line.endswith(form)) == files


def test_a_run_that_did_not_end_is_exported_with_its_state(tmp_path, run_command):
    folder = make_run(tmp_path)
    edit(folder, exit_status="recording")
    os.utime(folder / "log.mcap", (0, 0))
    ended = run_command("export", folder, "--out", tmp_path / "out")
    said = (
        r"WARNING: the run has not ended, state 'recovered': its recorder was killed; .* to (.*) s"
    )
    end = float(re.match(said, ended.out)[1])
    assert f"  recovered  {end:.1f} s  " in run_command("runs", tmp_path).out
    os.utime(folder / "log.mcap")
    ended = run_command("export", folder, "--out", tmp_path / "now")
    assert ended.out.startswith("WARNING: the run has not ended, state 'recording': it is being ")
    edit(folder, exit_status="completed")
    assert "WARNING" not in run_command("export", folder, "--out", tmp_path / "more").out


def test_topics_of_a_log_for_viewers_are_counted(tmp_path, run_command, monkeypatch):
    def export_mcap(run: Path, *, out: Path) -> Exported:
        return Exported(out, {"/tf": 12, "/track": 3}, (f"of {run.name}",))

    monkeypatch.setattr(export_mcap_stage, "export_mcap", export_mcap)
    ended = run_command("export", "a-run", "--out", tmp_path / "a.mcap", "--to", "mcap")
    assert (ended.code, ended.err) == (0, "")
    assert (
        ended.out
        == f"/tf: 12 messages\n/track: 3 messages\nof a-run\nwrote {tmp_path / 'a.mcap'}\n"
    )
