# SPDX-License-Identifier: MIT
"""Time the commands around a prediction, from their start to their last file.

Prints the tables of the chapter "Predicting" of docs/benchmarks.md. Everything is simulated: walks
of 30 s by our own model, leg angles counted in steps of 3.6 degrees at 100 Hz, a track every 2 s.

Usage: python -m benchmarks.speed.prediction CALIBRATION

CALIBRATION is a folder that `calibrate-slip` made, for example of `datasets/rig-sim`. It is copied.
"""

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np
import pandas as pd

from benchmarks.machine import describe_machine
from benchmarks.tables import print_table
from model.gait import tripod_angles, tripod_reference
from model.robot import GRAVITY, Robot
from model.walk.ensemble import WalkDraw, planar_walk
from zebro_lab.calibration.slip_argument import parse_slip

Side: TypeAlias = Literal["left", "right"]

DURATION = 30.0  # s
STEP = np.radians(3.6)
EVERY = 2.0  # s
NOISE = np.array([0.002, 0.002, np.radians(0.3)])
TURNS: tuple[tuple[float, Side], ...] = (
    (1.0, "left"),
    (1.1, "left"),
    (1.2, "right"),
    (1.3, "left"),
)
DRAWS = 1000
BIN = Path(sys.executable).parent


def write_walk(folder: Path, steering: float, side: Side, calibration: Path, seed: int) -> Path:
    """Write a walk's counted leg log and its track."""
    reference = tripod_reference(tripod_angles(np.radians(50.0), steering), 2.0, direction=side)
    robot = Robot()
    law = parse_slip(str(calibration), with_walks=False).traction_table(weight=robot.mass * GRAVITY)
    true = planar_walk(WalkDraw(robot, reference, law), duration=DURATION).poses
    (folder / "track").mkdir(parents=True)
    t = np.arange(0.0, DURATION, 0.01)
    counted = STEP * np.round(reference.angles(t) / STEP)
    pd.DataFrame({"t": t} | {f"theta{i + 1}": a for i, a in enumerate(counted.T)}).to_csv(
        folder / "legs.csv", index=False
    )
    seen = np.arange(0.0, DURATION, EVERY)
    noise = np.random.default_rng(seed).normal(size=(len(seen), 3)) * NOISE
    truth = true.at(seen).states.T
    x, y, yaw = truth + noise.T
    covariance = dict(zip(("cov_xx", "cov_yy", "cov_yawyaw"), NOISE**2, strict=True))
    pd.DataFrame({
        "t_s": seen, "x_m": x, "y_m": y, "yaw_rad": yaw, **covariance,
        "cov_xy": 0.0, "cov_xyaw": 0.0, "cov_yyaw": 0.0,
    }).to_csv(folder / "track" / "track.csv", index=False)  # fmt: skip
    return folder


def took(*command: object) -> tuple[str, str]:
    """Run a command and return its wall time and its processor time of all threads, in s."""
    began, used = time.perf_counter(), _processor()
    subprocess.run([str(each) for each in command], check=True, capture_output=True)
    return f"{time.perf_counter() - began:.1f}", f"{_processor() - used:.1f}"


def _processor() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    """Print the tables."""
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    print(describe_machine())
    with tempfile.TemporaryDirectory() as scratch:
        place = Path(scratch)
        calibration = place / "calibration"
        shutil.copytree(sys.argv[1], calibration, ignore=shutil.ignore_patterns("walks"))
        walks = [
            write_walk(place / f"walk{i}", steering, side, calibration, i)
            for i, (steering, side) in enumerate(TURNS)
        ]
        predict = [
            BIN / "zebro-lab", "predict", walks[2] / "legs.csv", "--slip", calibration,
            "--draws", DRAWS, "--out", place / "prediction",
        ]  # fmt: skip
        took(*predict)  # compiles, where nothing was compiled yet
        rows = [(f"predict, {DRAWS} draws of {DURATION:g} s, the rig's law", *took(*predict))]
        named = [each for walk in walks for each in ("--walks", walk)]
        fitted = took(BIN / "calibrate-slip", *named, "--out", calibration)
        rows.append((f"calibrate-slip --walks, {len(walks)} walks of {DURATION:g} s", *fitted))
        rows.append((f"predict, {DRAWS} draws of {DURATION:g} s, walks informed", *took(*predict)))
        print()
        print_table(("command", "seconds", "processor seconds"), *rows)


if __name__ == "__main__":
    main()
