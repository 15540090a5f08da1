# SPDX-License-Identifier: MIT
"""Poses of a ROS log as the columns of a track."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from model.slip.law import Array
from zebro_lab.exchange.topic_table import TopicTable
from zebro_lab.track.trajectory.logged_poses import read_logged_poses

_PLANAR: Final = {
    "cov_xx": 0, "cov_xy": 1, "cov_xyaw": 5, "cov_yy": 7, "cov_yyaw": 11, "cov_yawyaw": 35,
}  # fmt: skip
"""Index of each planar element among the 36 of a pose's covariance, by rows."""


def read_pose_log(
    path: Path, *, topic: str | None = None, topics: Collection[str] = ()
) -> TopicTable:
    """Read poses of a ROS log as the columns of a track, up to the first damage.

    Args:
        path: The log: MCAP or a bag.
        topic: Topic to read; see `read_logged_poses`.
        topics: Topics to prefer.

    Returns:
        `t_s` [s], `x_m`, `y_m`, `z_m` [m]; `yaw_rad` [rad], unwrapped, and the planar covariance,
        where the messages have them; the topic.

    Raises:
        NotFound: As in `read_logged_poses`.
        DataError: As in `read_logged_poses`.
    """
    found = read_logged_poses(path, topic=topic, topics=topics)
    columns: dict[str, Array] = dict(zip(("x_m", "y_m", "z_m"), found.position.T, strict=True))
    columns = {"t_s": np.array(found.rows.t), **columns}
    if found.quaternion is not None:
        columns["yaw_rad"] = _yaw(found.quaternion)
        if found.covariance is not None:
            columns |= {name: found.covariance[:, index] for name, index in _PLANAR.items()}
    read = TopicTable.of(path, columns, found.rows)
    return replace(read, table=replace(read.table, units={"yaw_rad": "rad"}))


def _yaw(quaternion: Array) -> Array:
    """Return the unwrapped yaw of quaternions x, y, z, w, shape (n, 4), in (n,) [rad]."""
    qx, qy, qz, qw = quaternion.T
    return np.unwrap(np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2)))
