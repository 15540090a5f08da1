# SPDX-License-Identifier: MIT
"""The table of improbable values has the limits that the code has."""

import re
from pathlib import Path
from pkgutil import resolve_name

import numpy as np
import pytest

FORMATS = Path(__file__).parents[2] / "docs" / "formats.md"
LIMITS = {
    "radii of a rig's discs": "calibration.plausible:LARGEST_RADIUS",
    "slip ratio computed": "calibration.plausible:LARGEST_SLIP",
    "traction over normal force": "calibration.plausible:FRICTION",
    "turn of a disc": "tables.disc_angles:DISAGREEMENT",
    "one traction force": "calibration.plausible:STRAY",
    "`load_cell.gain_sd`": "tables.columns_file:LARGEST_LOAD_CELL_ERROR",
    "`rig_errors.radius` and `run_out`": "tables.columns_file:LARGEST_RIG_ERROR",
    "`--slip coulomb:MU`": "calibration.coulomb_argument:MOST_FRICTION",
    "lengths in `robot.toml`": "robot.robot_file:LARGEST",
    "mass in `robot.toml`": "robot.robot_file:HEAVIEST",
    "`--time` of `rig suggest`": "suggest.request:LONGEST_TIME",
    "`--rate` of `rig suggest`": "suggest.request:HIGHEST_RATE",
    "`--dt` with slip": "walk.request:LONGEST_SLIPPING_STEP",
    "`--dt` without slip": "walk.request:LONGEST_STEP",
    "duration over `--dt`": "walk.walking:MOST_STEPS",
    "time between samples": "tables.columns:INTERVALS",
    "turn of a leg": "robot.leg_log:LONGEST_TURN",
    "gap in a leg log": "robot.leg_log:LONGEST_BRIDGED",
    "roll and pitch": "robot.imu_log:LARGEST_TILT",
    "`--track-sd`": "exchange.import_request:LARGEST_SD",
    "mean speed of a path": "track.trajectory.table:FASTEST",
    "interval by": "track.photo_sequence:MOST_APART",
}
"""Limit of each row, in `zebro_lab`, by the beginning of what the row is about."""


@pytest.mark.parametrize("about", LIMITS)
def test_a_documented_limit_is_that_of_the_code(about):
    section = FORMATS.read_text(encoding="utf-8").split("\n## Improbable values\n")[1]
    (row,) = [line for line in section.splitlines() if line.startswith(f"| {about}")]
    found = [float(each) for each in re.findall(r"\d[\d.]*(?:e-?\d+)?", row.split("|")[2])]
    limit = resolve_name(f"zebro_lab.{LIMITS[about]}")
    limits = limit.values() if isinstance(limit, dict) else np.atleast_1d(limit)
    assert any(number == pytest.approx(each, rel=1e-3) for each in limits for number in found)
