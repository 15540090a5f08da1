# SPDX-License-Identifier: MIT
"""The table of improbable values has the limits that the code has."""

import re
from pathlib import Path

import pytest

from zebro_lab.calibration.coulomb_argument import MOST_FRICTION
from zebro_lab.calibration.plausible import FRICTION, LARGEST_RADIUS, LARGEST_SLIP, STRAY
from zebro_lab.exchange.import_request import LARGEST_SD, LARGEST_SD_YAW
from zebro_lab.robot.gait_argument import LEAST_DEG
from zebro_lab.robot.imu_log import LARGEST_TILT, NEAR_G
from zebro_lab.robot.leg_gaps import LONGEST_BRIDGED
from zebro_lab.robot.leg_log import LONGEST_TURN, LONGEST_WRAPPED
from zebro_lab.robot.marker_print import LARGEST_PRINT
from zebro_lab.robot.robot_file import HEAVIEST, LARGEST
from zebro_lab.suggest.request import HIGHEST_RATE, LONGEST_TIME
from zebro_lab.tables.columns import INTERVALS
from zebro_lab.tables.columns_file import LARGEST_LOAD_CELL_ERROR, LARGEST_RIG_ERROR
from zebro_lab.tables.disc_angles import DISAGREEMENT
from zebro_lab.track.photo_sequence import MOST_APART
from zebro_lab.track.trajectory.table import FASTEST
from zebro_lab.walk.request import LONGEST_SLIPPING_STEP, LONGEST_STEP
from zebro_lab.walk.walking import MOST_STEPS

FORMATS = Path(__file__).parents[2] / "docs" / "formats.md"
LIMITS = {
    "radii of a rig's discs": (LARGEST_RADIUS,),
    "slip ratio computed": (LARGEST_SLIP,),
    "traction over normal force": FRICTION,
    "turn of a disc": (1, DISAGREEMENT),
    "one traction force": (STRAY,),
    "`load_cell.gain_sd`": (LARGEST_LOAD_CELL_ERROR,),
    "`rig_errors.radius` and `run_out`": (LARGEST_RIG_ERROR["m"],),
    "`rig_errors.radius_ratio`": (LARGEST_RIG_ERROR["dimensionless"],),
    "`--slip coulomb:MU`": (MOST_FRICTION,),
    "lengths in `robot.toml`": (LARGEST,),
    "mass in `robot.toml`": (HEAVIEST,),
    "`--time` of `rig suggest`": (LONGEST_TIME,),
    "`--rate` of `rig suggest`": (HIGHEST_RATE,),
    "angles of a gait": (0, LEAST_DEG),
    "`--dt` with slip": (LONGEST_SLIPPING_STEP,),
    "`--dt` without slip": (LONGEST_STEP,),
    "duration over `--dt`": (MOST_STEPS,),
    "time between samples": INTERVALS,
    "turn of a leg": (LONGEST_TURN, LONGEST_WRAPPED),
    "gap in a leg log": (LONGEST_BRIDGED,),
    "specific force": (1, NEAR_G),
    "roll and pitch": (LARGEST_TILT,),
    "`--track-sd`": (LARGEST_SD, LARGEST_SD_YAW),
    "mean speed of a path": (FASTEST,),
    "interval by": (MOST_APART, 1 / MOST_APART),
}
"""Limits of each row, by the beginning of what it is about, in the order of its second column."""


def rows() -> list[list[str]]:
    """Return the cells of the rows of the table, without its head."""
    section = FORMATS.read_text(encoding="utf-8").split("\n## Improbable values\n")[1]
    lines = [line for line in section.split("\n## ")[0].splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


@pytest.mark.parametrize("about", LIMITS)
def test_a_documented_limit_is_that_of_the_code(about):
    [(_, expected, _)] = [row for row in rows() if row[0].startswith(about)]
    found = [float(number) for number in re.findall(r"\d[\d.]*(?:e-?\d+)?", expected)]
    assert found == [pytest.approx(limit, rel=1e-3) for limit in LIMITS[about]]


def test_lengths_of_prints_have_the_limit_of_the_robot_file_whose_row_they_share():
    assert LARGEST_PRINT == LARGEST


def test_every_row_with_a_number_is_compared():
    numbered = [row[0] for row in rows() if re.search(r"\d", row[1])]
    assert len(numbered) == len(LIMITS)
