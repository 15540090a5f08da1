# SPDX-License-Identifier: MIT
"""What twins record goes all the way: rig and robot, photographs, and a judged prediction."""

import json
import subprocess
import tomllib
from contextlib import contextmanager
from itertools import takewhile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.slip.thesis_curve import THESIS_VALUES
from support.bundled_walk import WALK
from support.commands import COMMAND

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]

PLAN = Path(__file__).parents[2] / "examples/plan-thesis.toml"
FEW_STEPS = ("--law", "coulomb-stribeck", "--max-steps", 400)
STOOD = 12.0  # s that the robot stands, until `record` runs
LASTS = 44.0  # s of the recording: the stand, less what passes before it, and the walk


def run(*arguments: object, code: int = 0) -> str:
    """Run a command as a process of its own; return what it printed."""
    ended = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True,
                           check=False)  # fmt: skip
    assert ended.returncode == code, ended
    return ended.stdout + ended.stderr


def small_plan(file: Path) -> Path:
    """Write the thesis's plan with two loads and 16 slip ratios."""
    text = PLAN.read_text()
    for old, new in (
        ("loads = [2.13, 6.63, 8.13, 12.75]", "loads = [4.0, 12.0]"),
        ("count = 62", "count = 16"), ("_every = 62", "_every = 16"),
    ):  # fmt: skip
        assert old in text
        text = text.replace(old, new)
    file.write_text(text)
    return file


def write_walked(file: Path) -> Path:
    """Write the leg angles of the photographed walk, every 10 ms, after a stand of `STOOD`."""
    truth = pd.read_csv(WALK / "truth.csv")
    t = np.arange(0.0, STOOD + truth["t"].iloc[-1], 0.01)
    legs = {f"theta{i}": np.interp(t - STOOD, truth["t"], truth[f"theta{i}"]) for i in range(1, 7)}
    pd.DataFrame({"t": t} | legs).to_csv(file, index=False)
    return file


@contextmanager
def served(*arguments: object):
    """Serve a twin by `zebro-lab sim`; yield its address."""
    command = [COMMAND, "sim", *map(str, arguments), "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as twin:
        try:
            document = "".join(takewhile(lambda line: line != "}\n", twin.stdout or ()))
            yield json.loads(document + "}")["address"]
        finally:
            twin.terminate()


def photographs_began(run_folder: Path) -> str:
    """Return the date by the photographs' clock, 12:00 as the walk begins, of a run's time zero."""
    clock = json.loads((run_folder / "run.json").read_text())["clocks"]["legs"]
    since = pd.Timedelta(seconds=STOOD + clock["offset"])
    return (pd.Timestamp("2020-06-01T12:00:00+00:00") - since).isoformat()


def test_recorded_twins_end_in_a_judged_prediction_on_one_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    play = ("--play", write_walked(tmp_path / "walked.csv"))
    with served("zebro", *play) as legs, served("imu", *play) as imu:
        asked = ("--duration", LASTS, "--label", "walked", "--data", "data")
        run("record", "--zebro", legs, "--imu", imu, *asked)
    run("rig", "plan", small_plan(tmp_path / "plan.toml"))
    run("rig", "run", "plan.toml", "--rig", "sim", "--fast", "--data", "experiment")
    said = run("calibrate", "experiment", *FEW_STEPS)
    assert "verdict: " in said
    run("rig", "check", "experiment")
    found = pd.read_csv("calibration/summary.csv").set_index("parameter")
    assert found.loc["friction", "median"] == pytest.approx(THESIS_VALUES[2], rel=0.1)
    (walked,) = Path("data").iterdir()
    run("track", WALK / "photos", "--camera", WALK / "camera.toml", "--floor", WALK / "floor.toml",
        "--robot", WALK / "robot.toml", "--run", walked,
        "--start", photographs_began(walked))  # fmt: skip
    run("predict", walked, "--slip", "calibration", "--robot", WALK / "robot.toml", "--draws", 60)
    judged = run("validate", walked)
    assert "roll: error against the IMU" in judged
    errors = pd.read_csv(walked / "validation/metrics.csv").set_index("model")
    # Half again as much as the furthest, 2.4 %, of this walk counted from ten other moments on: a
    # cycle lasts 180 samples, so that what the counts leave open is the same in each.
    assert errors.loc["prediction", "ate_of_length"] < 0.036
    assert errors.loc["prediction", "ate_m"] < 0.1 * errors.loc["stand still", "ate_m"]
    said = run("report", walked, "--out", "page.html")
    assert "does not belong together" not in said
    state = tomllib.loads(Path("calibration/slip.toml").read_text())["verdict"]["state"]
    assert state in Path("page.html").read_text()
