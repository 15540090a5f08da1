# SPDX-License-Identifier: MIT
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.skipif(sys.platform != "linux", reason="both processes must share one clock")
@pytest.mark.long
def test_a_stop_and_a_guard_end_as_line_code_and_journal_say():
    process = subprocess.run(
        [sys.executable, "-m", "benchmarks.faults.stop_latency", "1", "SIGTERM", "normal force"],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    lines = process.stdout.splitlines()
    rows = [line.strip("| ").split(" | ") for line in lines if line.endswith(" |")][1:]
    assert [row[0] for row in rows] == ["SIGTERM", "guard: normal force"], process.stderr
    for _, trials, latency, _, rest, _, agree in rows:
        assert (trials, agree) == ("1", "1 of 1"), process.stdout
        assert 0 < float(latency) < float(rest)
