# SPDX-License-Identifier: MIT
"""In an ASCII locale names, labels and sources of any language go from the tables to the page."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from support.bundled_walk import WALK
from support.calibrate_processes import JUDGED_EARLY
from support.commands import COMMAND
from support.other_labs import RIG_COLUMNS, write_rig_table

ASCII = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
FIT = [
    sys.executable,
    "-c",
    f"{JUDGED_EARLY}from zebro_lab.start import calibrate_slip as go; go()",
]


def test_a_name_that_ascii_lacks_is_read_and_printed(tmp_path):
    folder = tmp_path / "Läufe μ"
    folder.mkdir()
    assert in_ascii([COMMAND, "runs", folder], tmp_path) == f"0 runs in {folder}\n"


def test_what_a_stream_cannot_write_is_printed_as_an_escape(tmp_path):
    (tmp_path / "Läufe μ").mkdir()
    latin = os.environ | {"PYTHONIOENCODING": "latin-1"}
    command = [COMMAND, "runs", "Läufe μ"]
    done = subprocess.run(command, cwd=tmp_path, env=latin, capture_output=True, check=True)
    assert done.stdout.decode("latin-1") == "0 runs in Läufe \\u03bc\n"


@pytest.mark.long
def test_tables_with_labels_of_any_language_end_on_one_page(tmp_path):
    bench = tmp_path / "Prüfstand"
    bench.mkdir()
    write_rig_table(bench)
    (bench / "columns.toml").write_text(RIG_COLUMNS, encoding="utf-8")
    in_ascii([COMMAND, "import", "--legs", WALK / "legs.csv", "--robot", WALK / "robot.toml",
              "--label", "Grüße", "--operator", "Jürgen", "--data", "Läufe",
              "--start", "2026-03-04T05:06:07+00:00"], tmp_path)  # fmt: skip
    law = ["--law", "coulomb-stribeck", "--max-steps", "100", "--threads", "1"]
    in_ascii([*FIT, bench, *law, "--out", "Läufe/Schlupf"], tmp_path, code=3)
    run = "Läufe/20260304T050607Z_walk_Grüße"
    in_ascii([COMMAND, "predict", run, "--slip", "Läufe/Schlupf", "--draws", "5"], tmp_path)
    in_ascii(
        [COMMAND, "report", run, "--out", "Läufe/Bericht.html", "--title", "Übersicht μ"], tmp_path
    )
    page = (tmp_path / "Läufe/Bericht.html").read_text(encoding="utf-8")
    for text in ("Grüße", "Jürgen", "Übersicht μ"):
        assert text in page


def in_ascii(command: list[object], folder: Path, *, code: int = 0) -> str:
    """Run a command in an ASCII locale, and return what it printed as text."""
    done = subprocess.run(
        list(map(str, command)),
        cwd=folder,
        env=os.environ | ASCII,
        capture_output=True,
        check=False,
    )
    assert done.returncode == code, done.stderr.decode()
    return done.stdout.decode()
