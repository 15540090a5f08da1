# SPDX-License-Identifier: MIT
"""`zebro-lab export` names every file that it writes."""

import pytest

from support.written_runs import make_run
from zebro_lab.exchange.export_command import ExportFormat


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_every_table_is_named(tmp_path, run_command, form):
    out = tmp_path / "out"
    ended = run_command("export", make_run(tmp_path), "--out", out, "--to", form)
    assert (ended.code, ended.err) == (0, "")
    files = sorted(f"wrote {file}" for file in out.iterdir() if file.suffix == f".{form}")
    assert len(files) == 2
    assert sorted(line for line in ended.out.splitlines() if line.endswith(form)) == files


def test_topics_of_a_log_for_viewers_are_counted(files, tmp_path, run_command):
    run_command("import", "--legs", files / "legs.csv", "--data", tmp_path, "--label", "a",
                "--start", "2026-01-01T00:00:00+00:00")  # fmt: skip
    run, out = tmp_path / "20260101T000000Z_walk_a", tmp_path / "a.mcap"
    ended = run_command("export", run, "--out", out, "--to", ExportFormat.MCAP)
    assert (ended.code, ended.err) == (0, "")
    lines = ended.out.splitlines()
    assert lines[-1] == f"wrote {out}"
    assert out.is_file()
    assert any(line.startswith("/") and line.endswith(": 100") for line in lines)
