# SPDX-License-Identifier: MIT
"""Calibrations and runs that are compared."""

import numpy as np
import pandas as pd

from zebro_lab.validation.compare.stage import compare

SLIP_TOML = """
schema = 1
source = "sim:rig-sweep"
slip_definition = "{definition}"
law = {{ name = "coulomb-stribeck", stribeck = false }}
[parameters]
slip_stiffness = {{ mean = 20.0 }}
friction = {{ mean = {friction} }}
[covariance]
matrix = [[1.0, 0.0], [0.0, {variance}]]
[tested]
normal_force = {loads}
slip_ratio = [0.0, 1.0]
"""


def calibration(folder, *, friction=0.4, sd=0.01, definition="material", loads=(2.0, 13.0)):
    """Write a calibration of a Coulomb law."""
    folder.mkdir(parents=True)
    text = SLIP_TOML.format(
        definition=definition, friction=friction, variance=sd**2, loads=list(loads)
    )
    (folder / "slip.toml").write_text(text)
    return folder


def run_folder(folder, *, radius=2.0, speed=0.08, sd=0.002, seed=1, yaw=True):
    """Write a run with a track of a circle, walked and turned to somewhere on the floor."""
    (folder / "track").mkdir(parents=True)
    t = np.arange(0.0, 30.0, 2.0)
    turned = speed * t / radius
    heading = turned + 0.7
    position = radius * np.column_stack([np.sin(turned), 1 - np.cos(turned)])
    c, s = np.cos(0.7), np.sin(0.7)
    rng = np.random.default_rng(seed)
    noise = rng.normal(0, sd, (len(t), 3))
    table = pd.DataFrame({
        "t_s": t, "x_m": 1 + c * position[:, 0] - s * position[:, 1] + noise[:, 0],
        "y_m": s * position[:, 0] + c * position[:, 1] + noise[:, 1],
        "cov_xx": sd**2, "cov_xy": 0.0, "cov_xyaw": 0.0, "cov_yy": sd**2, "cov_yyaw": 0.0,
        "cov_yawyaw": sd**2,
    })  # fmt: skip
    if yaw:
        table["yaw_rad"] = heading + noise[:, 2]
    table.to_csv(folder / "track" / "track.csv", index=False)
    return folder


def compared(first, second, out):
    """Compare two folders; return the comparison, and differences by name."""
    done = compare(first, second, out=out)
    return done, dict(
        zip([q.name for q in done.comparison.quantities], done.differences, strict=True)
    )
