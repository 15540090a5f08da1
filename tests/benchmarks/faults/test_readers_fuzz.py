# SPDX-License-Identifier: MIT
"""A few generated files for every reader of users' files; the whole trial is a script."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.long
def test_a_few_generated_files_end_in_one_line_each():
    process = subprocess.run(
        [sys.executable, "-m", "benchmarks.faults.readers_fuzz", "--inputs", "25",
         "--without-bombs"],
        capture_output=True, text=True, check=False, timeout=250, cwd=ROOT,
    )  # fmt: skip
    assert process.returncode == 0, process.stdout + process.stderr
    rows = [line.split(" | ") for line in process.stdout.splitlines() if line.startswith("| ")][1:]
    assert len(rows) > 30
    assert {row[1] for row in rows} == {"25"}
    assert {row[5] for row in rows} == {"0"}
