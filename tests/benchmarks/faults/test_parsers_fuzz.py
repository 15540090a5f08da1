# SPDX-License-Identifier: MIT
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]


def test_a_few_generated_inputs_raise_nothing_but_what_is_documented():
    process = subprocess.run(
        [sys.executable, "-m", "benchmarks.faults.parsers_fuzz", "100"],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert process.returncode == 0, process.stdout + process.stderr
    rows = [line.split(" | ") for line in process.stdout.splitlines() if line.startswith("| ")]
    assert len(rows) > 15
    assert {row[1] for row in rows[1:]} == {"100"}
