# SPDX-License-Identifier: MIT
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.skipif(sys.platform != "linux", reason="both processes must share one clock")
def test_the_age_of_every_stream_is_measured_and_seen_by_the_guards():
    process = subprocess.run(
        [sys.executable, "-m", "benchmarks.speed.reading_age", "--ramps", "1", "--seconds", "0.5",
         "--no-fit"],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=120,
    )  # fmt: skip
    assert process.returncode == 0, process.stdout + process.stderr
    rows = [line.strip("| ").split(" | ") for line in process.stdout.splitlines()[2:-2]]
    assert [row[0] for row in rows] == ["SLCAN, drives", "UDP, load cell", "serial, board"]
    for _, count, median, late, worst, _ in rows:
        assert int(count) > 20
        assert -1.0 < float(median) <= float(late) <= float(worst)  # [ms]
