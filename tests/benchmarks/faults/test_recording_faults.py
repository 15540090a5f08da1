# SPDX-License-Identifier: MIT
"""The benchmark of faults while recording runs, and its tables say what recording promises."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.skipif(sys.platform == "win32", reason="terminals and pipes of POSIX")
def test_one_trial_of_each_fault_is_a_row_and_nothing_is_lost():
    process = subprocess.run(
        [sys.executable, "-m", "benchmarks.faults.recording_faults", "1", "1.5"],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=250,
    )  # fmt: skip
    assert process.returncode == 0, process.stdout + process.stderr
    rows = [line.strip("| ").split(" | ") for line in process.stdout.splitlines() if "|" in line]
    by_name = {cells[0]: cells for cells in rows}
    assert set(by_name) >= {"line on stderr", "process ended"}
    ends = [cells for cells in rows if cells[0] in ("fsync takes 3 s", "terminal stopped",
                                                    "pipe full, nobody reads")]  # fmt: skip
    assert len(ends) == 4
    assert {cells[-1] for cells in ends} == {"0"}
    assert all(float(cells[4].split()[0]) > -1.0 for cells in ends)
