# SPDX-License-Identifier: MIT
"""A lab's own leg, IMU and track files, and how they are imported."""

from datetime import UTC, datetime

import numpy as np

from support.watchers import Nobody
from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.exchange.import_stage import import_run

T = np.arange(0.0, 2.0, 0.02)


THETA = 4.0 * T[:, None] + np.arange(6)


YAW = 0.1 * T[::20]


COLUMNS = """
source = "sim:other-lab"

[legs.columns]
t = {name = "time_ms", unit = "ms"}
theta1 = {name = "fl", unit = "deg"}
theta2 = {name = "fr", unit = "deg", sign = -1}

[imu.columns]
rate_z = {name = "yaw_rate", unit = "deg/s"}

[track.columns]
x_m = {name = "east_mm", unit = "mm"}
y_m = {name = "north_mm", unit = "mm"}
"""


def taken(tmp_path, **files):
    request = ImportRequest(data=tmp_path / "data", **files)
    return import_run(request, Nobody())


def everything(files, tmp_path, track="track.csv"):
    imported = taken(
        tmp_path, legs=files / "legs.csv", imu=files / "imu.csv", track=files / track,
        robot=files / "robot.toml", label="circle", start=datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC),
    )  # fmt: skip
    folder = imported.folder
    return folder, imported.notes
