# SPDX-License-Identifier: MIT
"""Pitch spikes of predicted walks against how finely the leg angles are known.

python -m benchmarks.accuracy.pitch_spikes

The bundled simulated walk is walked again by the project's model, with the engine's own friction
law: from the engine's leg angles, from samples of them between which the corners lie where a leg
changes from swing to stance, and from the log's encoder counts, at the log's samples alone and with
the corners between them.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.tables import print_table
from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference, SampledReference
from model.gait.resolution import find_step
from model.robot import GRAVITY
from model.slip.law import Array
from model.walk.dynamics import walk
from model.walk.path import WalkPath
from model.walk.traction import VelocityCoulomb
from zebro_lab.robot.robot_file import read_robot_file

DATA = Path(__file__).parents[2] / "datasets" / "walk-sim"
FRICTION, SPEED = 0.38, 0.001  # of the engine: coulomb:0.38:0.001 [-, m/s]
WALKING = 1.2, 27.5  # s, of the steps alone


def main() -> None:
    """Walk with each set of leg angles and print pitch, time in the air and error of the end."""
    truth = pd.read_csv(DATA / "truth.csv")
    robot = read_robot_file(DATA / "robot.toml").robot
    law = VelocityCoulomb(FRICTION, SPEED).table(weight=robot.mass * GRAVITY)
    t = truth["t"].to_numpy()
    end = truth[["x", "y"]].to_numpy()[-1]
    pitch = np.degrees(truth["pitch"].to_numpy()[(t > WALKING[0]) & (t < WALKING[1])])
    rows: list[tuple[str, ...]] = [
        ("the engine itself", f"{pitch.min():.2f}", f"{pitch.max():.2f}", "0", "")
    ]
    for name, legs in leg_angles(truth).items():
        path = walk(robot, legs, law, duration=float(t[-1]) - 0.1)
        rows.append((name, *_measured(path, end)))
    head = ("leg angles", "pitch from [deg]", "to [deg]", "no leg down [ms]", "end off [mm]")
    print_table(head, *rows)


def leg_angles(truth: pd.DataFrame) -> dict[str, LegReference]:
    """Return the walk's leg angles as they are known in four ways, by name.

    Args:
        truth: The engine's walk, with times and leg angles every 10 ms.
    """
    t, theta = truth["t"].to_numpy(), _legs_of(truth)
    log = pd.read_csv(DATA / "legs.csv")
    times, counted = log["t"].to_numpy(), _legs_of(log)
    step = find_step(counted)
    if step is None:
        raise ValueError("the log's angles are not counted")
    rebuilt = InexactLog(times, counted, step).smooth()
    return {
        "the engine's, every 10 ms": SampledReference(t, theta),
        "the engine's, every 20 ms, corners between samples": SampledReference(
            t[1::2] - t[1], theta[1::2]
        ),
        "the log's counts, rebuilt at its samples": SampledReference(times, rebuilt.angles(times)),
        "the log's counts, rebuilt with their corners": rebuilt,
    }


def _legs_of(table: pd.DataFrame) -> Array:
    return table[[f"theta{leg}" for leg in range(1, 7)]].to_numpy()


def _measured(path: WalkPath, end: Array) -> tuple[str, ...]:
    """Return extremes of pitch [deg], time without a leg on the ground [ms], error of the end."""
    steps = (path.t > WALKING[0]) & (path.t < WALKING[1])
    pitch = np.degrees(path.orientation[steps, 1])
    air = np.count_nonzero(~path.contact.any(axis=1)) * (path.t[1] - path.t[0])
    off = float(np.linalg.norm(path.position[-1, :2] - end))
    return f"{pitch.min():.2f}", f"{pitch.max():.2f}", f"{1e3 * air:.0f}", f"{1e3 * off:.0f}"


if __name__ == "__main__":
    main()
