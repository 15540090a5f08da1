# SPDX-License-Identifier: MIT
"""Tables that were given in the place of one of another kind."""

import pytest

from zebro_lab.robot.imu_log import IMU_UNITS
from zebro_lab.robot.leg_log import LEG_UNITS
from zebro_lab.tables.rig_columns import CANONICAL
from zebro_lab.tables.table_kinds import looks_like_other
from zebro_lab.track.trajectory.table import MAPPED_UNITS

MAPS = {"rig": CANONICAL, "legs": LEG_UNITS, "track": MAPPED_UNITS, "imu": IMU_UNITS}
TABLES = {
    "rig": (["t", "slip_ratio", "Normal_Force", "Traction_Force"], "calibrate-slip"),
    "legs": (["t", *(f"theta{leg}" for leg in range(1, 7))], "zebro-lab predict"),
    "track": (["t_s", "x_m", "y_m", "qw", "qx", "qy", "qz"], "import --track"),
    "imu": (["t", "roll", "pitch", "yaw_rate"], "as --imu"),
}


@pytest.mark.parametrize("kind", TABLES)
@pytest.mark.parametrize("expected", MAPS)
def test_a_table_of_another_kind_is_told_with_what_takes_it(kind, expected):
    headers, taker = TABLES[kind]
    said = looks_like_other(headers, MAPS[expected])
    assert said == "" if kind == expected else taker in said


def test_a_table_that_may_be_anything_is_not_called_one_of_a_kind():
    assert looks_like_other(["t", "ch1", "ch2", "theta1"], CANONICAL) == ""
