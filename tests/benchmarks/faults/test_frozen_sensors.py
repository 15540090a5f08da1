# SPDX-License-Identifier: MIT
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]


def test_a_short_plan_has_no_false_stop_and_frozen_sensors_are_seen():
    process = subprocess.run(
        [sys.executable, "-m", "benchmarks.faults.frozen_sensors", "--seeds", "1", "--points", "1",
         "--trials", "1", "--rows", "1"],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=240,
    )  # fmt: skip
    assert process.returncode == 0, process.stdout + process.stderr
    row = process.stdout.splitlines()[2].strip("| ").split(" | ")
    assert row == ["1e-05 N, 0.0001 rad/s", "1", "0", "1 of 1, 0.26 s", "1 of 1, 0.26 s"]
