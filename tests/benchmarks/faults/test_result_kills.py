# SPDX-License-Identifier: MIT
"""The trial of killed writers, in small."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]


def test_ten_kills_leave_whole_results_and_the_file_of_others():
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.faults.result_kills", "--kills", "10", "--seed", "7"],
        cwd=ROOT, capture_output=True, text=True, check=True,
    )  # fmt: skip
    rows = dict(line.strip("| ").split(" | ") for line in done.stdout.splitlines()[3:])
    assert "10 kills, seed 7" in done.stdout
    assert (rows["not whole"], rows["left beside"]) == ("0", "0")
    states = ("result alone", "both", "previous alone")
    assert sum(int(rows[state]) for state in states) == 10
