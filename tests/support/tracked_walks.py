# SPDX-License-Identifier: MIT
"""Walks with a counted leg log and a track, written to a folder."""

from pathlib import Path

import numpy as np
import pandas as pd

from model.gait import tripod_angles, tripod_reference

WALK = Path(__file__).parents[2] / "datasets" / "walk-sim"


STEP = np.radians(3.6)


SD = 0.002


def write_walk(folder, *, begin=5.0, late=0.0, covariance=True, yaw=True, robot=None, every=2.0):
    """Write a walk with a counted leg log from `begin` on and a track `late` by its clock."""
    gait = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
    t = np.arange(0.0, 12.0, 0.01)
    counted = STEP * np.round(gait.angles(t) / STEP)
    (folder / "track").mkdir(parents=True)
    pd.DataFrame({"t": t + begin} | {f"theta{i + 1}": a for i, a in enumerate(counted.T)}).to_csv(
        folder / "legs.csv", index=False
    )
    seen = np.arange(0.0, 12.0, every)
    table = pd.DataFrame({"t_s": seen + begin + late, "x_m": 0.08 * seen, "y_m": 0.0})
    if yaw:
        table["yaw_rad"] = 0.0
    if covariance:
        for name in ("xx", "yy", "yawyaw"):
            table[f"cov_{name}"] = SD**2
        for name in ("xy", "xyaw", "yyaw"):
            table[f"cov_{name}"] = 0.0
    table.to_csv(folder / "track" / "track.csv", index=False)
    if robot is not None:
        (folder / "robot.toml").write_text(robot)
    return folder
