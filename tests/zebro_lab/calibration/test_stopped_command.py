# SPDX-License-Identifier: MIT
"""A fit that is stopped or killed leaves a checkpoint, from which the same command goes on."""

import shlex
import signal
import subprocess
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest

from support.calibrate_processes import FILES, JUDGED_EARLY, SMALLER_FIT, names, patched, run

pytestmark = pytest.mark.timeout(600)

LOOK_OFTEN = "import zebro_lab.calibration.stage as stage; stage.CHECKPOINT_SECONDS = 0.0; "
EASILY_PLEASED = (
    "import model.bayes.drawing.convergence as rules; "
    "rules.MIN_LENGTH, rules.MIN_ESS, rules.MAX_R_HAT, rules.MAX_MCSE = 5, 50, 1.2, 0.5; "
)


def last_line(stderr: str) -> str:
    """Return the last line, below those that tell the progress of a slow fit."""
    *progress, last = stderr.splitlines(keepends=True)
    assert all(" of this step" in line for line in progress)
    return last


def start_and_signal(number: signal.Signals, command: list[str], out: Path) -> tuple[int, str, str]:
    """Start a fit, send it a signal once it has a checkpoint, and wait for its end."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        deadline = time.monotonic() + 300
        while not (out / "checkpoint.npz").exists():
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < deadline, "no checkpoint appeared"
            time.sleep(0.05)
        process.send_signal(number)
        stdout, stderr = process.communicate(timeout=120)
    finally:
        process.kill()
        process.wait()
    return process.returncode, stdout, stderr


@pytest.mark.parametrize(
    "number",
    [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.long)],
    ids=lambda number: number.name,
)
def test_stopped_fit_leaves_a_checkpoint_alone_and_resumes_to_convergence(sweep, tmp_path, number):
    out = tmp_path / "out"
    arguments = (sweep, "--out", out, *SMALLER_FIT)
    command = patched(LOOK_OFTEN + JUDGED_EARLY, *arguments)
    ending = start_and_signal(number, command, out)
    checkpoint = out / "checkpoint.npz"
    message, command = last_line(ending[2]).split("; go on with: ")
    assert (ending[0], message) == (130, f"stopped; {checkpoint} keeps the fit")
    assert "SIMULATED data, source 'sim:rig-sweep': 3600 samples" in ending[1]  # before the fit
    assert "verdict" not in ending[1]
    assert shlex.split(command)[1:] == [*map(str, arguments), "--resume"]
    assert names(out) == {"checkpoint.npz"}
    with np.load(checkpoint, allow_pickle=False) as stored:
        assert np.isfinite(stored["z"]).all()
    resumed = run(patched(EASILY_PLEASED, *arguments, "--resume"))
    assert resumed.returncode == 0
    assert "error" not in resumed.stderr
    assert names(out) == FILES
    assert tomllib.loads((out / "slip.toml").read_text())["verdict"]["converged"]


def test_killed_fit_leaves_a_checkpoint_that_resumes(sweep, tmp_path):
    out = tmp_path / "out"
    arguments = (sweep, "--out", out, *SMALLER_FIT)
    code, *_ = start_and_signal(signal.SIGKILL, patched(LOOK_OFTEN + JUDGED_EARLY, *arguments), out)
    assert code == -signal.SIGKILL
    resumed = run(patched(JUDGED_EARLY, *arguments, "--resume", "--max-steps", 1))
    assert resumed.returncode == 3
    assert "error" not in resumed.stderr
    assert names(out) >= FILES
