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

from support.calibrate_processes import EARLY, FILES, JUDGED_EARLY, SMALLER_FIT, names, patched
from support.quick_fits import NO_PRIOR_STARTS

pytestmark = [pytest.mark.timeout(600), pytest.mark.usefixtures("blank_pictures")]

LOOK_OFTEN = "import zebro_lab.calibration.stage as stage; stage.CHECKPOINT_SECONDS = 0.0; "
EASILY_PLEASED = {"MIN_LENGTH": 5, "MIN_ESS": 50, "MAX_R_HAT": 1.2, "MAX_MCSE": 0.5}
"""Rules by which a short fit has converged."""


def last_line(stderr: str) -> str:
    """Return the last line, below those that tell the progress of a slow fit."""
    *progress, last = stderr.splitlines(keepends=True)
    assert all(" of this step" in line for line in progress)
    return last


def judge_early(monkeypatch) -> None:
    """Let fits of this process start and end as those of processes do."""
    monkeypatch.setattr(*NO_PRIOR_STARTS)
    for name, value in EARLY.items():
        monkeypatch.setattr(f"model.bayes.calibrate.{name}", value)


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
def test_stopped_fit_leaves_a_checkpoint_alone_and_resumes_to_convergence(
    sweep, run_command, tmp_path, monkeypatch, number
):
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
    judge_early(monkeypatch)
    for name, value in EASILY_PLEASED.items():
        monkeypatch.setattr(f"model.bayes.drawing.convergence.{name}", value)
    resumed = run_command("calibrate-slip", *arguments, "--resume")
    assert resumed.code == 0
    assert "error" not in resumed.err
    assert names(out) == FILES
    assert tomllib.loads((out / "slip.toml").read_text())["verdict"]["converged"]


@pytest.mark.long
def test_killed_fit_leaves_a_checkpoint_that_resumes(sweep, run_command, tmp_path, monkeypatch):
    out = tmp_path / "out"
    arguments = (sweep, "--out", out, *SMALLER_FIT)
    code, *_ = start_and_signal(signal.SIGKILL, patched(LOOK_OFTEN + JUDGED_EARLY, *arguments), out)
    assert code == -signal.SIGKILL
    judge_early(monkeypatch)
    resumed = run_command("calibrate-slip", *arguments, "--resume", "--max-steps", 1)
    assert resumed.code == 3
    assert "error" not in resumed.err
    assert names(out) >= FILES
