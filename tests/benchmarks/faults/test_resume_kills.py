# SPDX-License-Identifier: MIT
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.long
def test_killed_experiments_are_resumed_so_that_each_point_counts_once():
    command = [sys.executable, "-m", "benchmarks.faults.resume_kills", "4", "3"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200, cwd=ROOT)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "4 experiments killed and resumed" in done.stdout
    assert "every point was counted once" in done.stdout
