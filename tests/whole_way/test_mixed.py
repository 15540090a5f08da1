# SPDX-License-Identifier: MIT
"""One folder holds runs of the rig, walks, an excluded run, some cut short, plots and results."""

import json
import math
import time
import tomllib
from datetime import datetime
from pathlib import Path

import pandas as pd
import pytest

from support.bundled_walk import WALK
from support.commands import started
from support.other_labs import rig_sweep, write_walk_tables
from support.table_runs import sweep_runs

FEW_STEPS = ("--law", "coulomb-stribeck", "--max-steps", 100)


def cut_short(data: Path, label: str, *devices: object) -> Path:
    """Record until there is a log with samples, kill the recorder, and return the run."""
    with started("record", *devices, "--label", label, "--data", data):
        for _ in range(600):
            for log in data.glob(f"*_{label}/log.mcap"):
                if log.stat().st_size > 200_000:
                    return log.parent
            time.sleep(0.1)
    raise AssertionError(f"{label}: nothing was recorded")


@pytest.fixture
def data(command, tmp_path, monkeypatch) -> Path:
    """Return a folder of 24 runs of the rig, of which one is excluded, and of two walks."""
    monkeypatch.chdir(tmp_path)
    capture = Path("capture")
    capture.mkdir()
    write_walk_tables(capture)
    start = "2026-03-04T05:06:07+00:00"
    sweep_runs(Path("data"), pd.DataFrame(rig_sweep()), start=datetime.fromisoformat(start))
    track = pd.read_csv(capture / "capture.csv")
    for label, first in (("one", 0), ("two", 1)):
        track.iloc[first::2].assign(**known_to(0.002)).to_csv(capture / "capture.csv", index=False)
        command("import", "--legs", capture / "legs.tsv", "--track", capture / "capture.csv",
                "--robot", WALK / "robot.toml", "--label", label, "--data", "data",
                "--start", start)  # fmt: skip
    command("exclude", min(Path("data").glob("*slip-rig*")), "--why", "the belt came off")
    return Path("data")


def known_to(sd: float) -> dict[str, float]:
    """Return the columns of a covariance: `sd` [m] and [rad], without correlation."""
    same, no = ("xx", "yy", "yawyaw"), ("xy", "xyaw", "yyaw")
    return {f"cov_{name}": sd**2 for name in same} | {f"cov_{name}": 0.0 for name in no}


@pytest.mark.long
@pytest.mark.timeout(900)
def test_a_mixed_folder_goes_the_whole_way(command, data):
    cut = cut_short(data, "cut", "--rig", "sim")
    cut_walk = cut_short(data, "cut-walk", "--rig", "sim", "--zebro", "sim")
    one, two = (next(data.glob(f"*_walk_{label}")) for label in ("one", "two"))
    walks = ("--walks", one, "--walks", two)
    said = command("calibrate", data, *walks, *FEW_STEPS, code=3)
    assert "the belt came off" in said
    assert f"left out, runs of another kind than slip-rig: {one.name} (walk)" in plain(said)
    assert f"{cut.name}: log.mcap is incomplete" in plain(said)
    assert cut_walk.is_dir()
    assert "legs and floor fitted to 2 walks" in plain(said)
    assert plain(said).count("1 ×/÷ 1.30") == 2  # priors of lateral grip and lateral stiffness
    fitted = tomllib.loads(Path("calibration/walks/walks.toml").read_text())
    assert fitted["prior"]["lateral_sd"] == pytest.approx(math.log(1.3))
    assert {"lateral_grip", "lateral_stiffness"} <= {each["name"] for each in fitted["parameter"]}
    for walked in (one, two):
        command("predict", walked, "--slip", "calibration", "--draws", 60)
        command("plot", walked)
    command("walk", "--model", "no-slip", "--duration", 4, "--out", data / "planned")
    command("runs", data)
    said = command("validate", *sorted(data.iterdir()), "--out", data / "validation")
    assert "left out, planned: no run folder" in plain(said)
    judged = json.loads((data / "validation/manifest.json").read_text())["runs"]
    assert set(judged) == {one.name, two.name}
    command("compare", one, two)
    said = command("report", data, "--out", "page.html")
    assert "does not belong together" not in said
    page = Path("page.html").read_text()
    assert "the belt came off" in page
    assert f"{two.name}: the predicted path is" in page
    # Calibrated again, with the results among the data, it is not what the predictions used.
    said = command("calibrate", data, *FEW_STEPS, "--seed", 2, code=3)
    assert "the belt came off" in said
    said = command("report", data, "--out", "page.html")
    assert said.count("the prediction was made with slip 'calibration', not with") == 2
    assert "Slip curve: " not in Path("page.html").read_text()


def plain(text: str) -> str:
    """Return text with line breaks as blanks."""
    return " ".join(text.split())
