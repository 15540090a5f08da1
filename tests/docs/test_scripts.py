# SPDX-License-Identifier: MIT
"""Scripts behind the figures of the documentation still do what their tables say."""

import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"


def test_a_few_generated_inputs_raise_nothing_but_what_is_documented():
    process = subprocess.run(
        [sys.executable, DOCS / "drivers_fuzz.py", "100"],
        capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert process.returncode == 0, process.stdout + process.stderr
    rows = [line.split(" | ") for line in process.stdout.splitlines() if line.startswith("| ")]
    assert len(rows) > 15
    assert {row[1] for row in rows[1:]} == {"100"}
