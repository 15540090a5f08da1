# SPDX-License-Identifier: MIT
"""Write an imported walk as a run folder; read the body's orientation from a ROS log."""

from collections.abc import Collection
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from model.arrays import Array
from model.robot import N_LEGS
from rig.device import Counters
from rig.imu.profile import render_table_profile
from rig.sample_columns import SampleColumns
from rig.zebro.profile import LegProfile, render_leg_profile
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.files.provenance import file_hashes
from zebro_lab.mcap.log_topics import OTHER_FIELDS, read_topic
from zebro_lab.robot.imu_log import ImuLog
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.robot.robot_file import ROBOT_FILE, RobotFile
from zebro_lab.runs.manifest import RunManifest
from zebro_lab.runs.table_run import table_samples, write_table_run
from zebro_lab.tables.columns import IMU, LEGS, TRACK
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.track.file import tum_lines
from zebro_lab.track.folder import track_folder
from zebro_lab.track.foreign import ForeignTrack

_DEGREES: Final = 360
"""Counts per revolution in the profile of imported angles: they are stored in degrees."""


@dataclass(frozen=True)
class ImportedWalk:
    """Data of an imported walk.

    Attributes:
        manifest: Manifest of the run, with its name, start and sources.
        zero: Time of the files at which the run began [s].
        legs: Leg angles, in the files' time; None without a file, and then there is a track.
        imu: Orientation, angular rate and specific force of the body, in the files' time; None
            without a file.
        track: Tracked path, in the run's time; None without a file.
        robot: The robot; the thesis's robot without a file.
        suspected: What is suspected of the leg angles, one line each; kept as events of the log.
    """

    manifest: RunManifest
    zero: float
    legs: LegLog | None
    imu: ImuLog | None
    track: ForeignTrack | None
    robot: RobotFile
    suspected: tuple[str, ...] = ()

    @property
    def files(self) -> tuple[Path, ...]:
        """Every file read, each once: legs, IMU, track and robot."""
        parts = [part.files for part in (self.legs, self.imu, self.track) if part is not None]
        robot = (self.robot.file,) if self.robot.file else ()
        return tuple(dict.fromkeys([f for part in parts for f in part] + list(robot)))


def write_imported_walk(data_dir: Path, walk: ImportedWalk) -> Path:
    """Write the run folder of an imported walk: log, profiles, manifest, robot.toml and track.

    Args:
        data_dir: Folder of run folders; created when missing.
        walk: The walk.

    Returns:
        The run folder.

    Raises:
        AlreadyExists: A run of this kind, start (to the second) and label exists.
        OSError: The folder cannot be written.
    """
    profiles: dict[str, str] = {}
    samples: dict[str, SampleColumns] = {}
    imu = walk.imu
    if walk.legs is not None:
        t = walk.legs.reference.t - walk.zero
        profiles[LEGS] = render_leg_profile(_leg_profile(_rate(t)))
        samples[LEGS] = table_samples(t, np.degrees(walk.legs.reference.theta))
    if imu is not None:
        profiles[IMU] = render_table_profile(_rate(imu.t), has_yaw=imu.has_yaw)
        samples[IMU] = table_samples(imu.t - walk.zero, imu.values)
    manifest = replace(
        walk.manifest,
        counters={
            name: asdict(Counters(received=len(columns))) | {"dropped": 0}
            for name, columns in samples.items()
        },
        robot=None if walk.robot.file is None else walk.robot.file.stem,
        inputs=file_hashes(walk.files),
    )
    return write_table_run(
        data_dir, manifest, samples, profiles=profiles,
        event=f"imported, source {manifest.source}", warnings=walk.suspected,
        extra=lambda draft: _write_more(draft, walk),
        until=0.0 if walk.track is None or samples else float(walk.track.track.poses.t[-1]),
    )  # fmt: skip


def _write_more(draft: Path, walk: ImportedWalk) -> None:
    """Copy the robot's file and write the track into the draft folder, as far as there are any."""
    if walk.robot.file is not None:
        atomic_write_text(draft / ROBOT_FILE, walk.robot.file.read_text(encoding="utf-8-sig"))
    if walk.track is None:
        return
    track = walk.track.track
    with track_folder(
        draft / TRACK,
        walk.track.columns,
        tum=tum_lines(track.poses).splitlines(),
        source=track.source,
        settings={"imported": str(track.file), "zero_s": walk.zero},
        inputs=file_hashes(walk.track.files),
        report={"notes": list(track.notes), "tracked": len(track.poses)},
    ):
        pass  # pictures would be added here; there are no photographs


def _leg_profile(rate: float) -> LegProfile:
    """Return the profile of imported leg angles: degrees as counts, canonical in zero and sign."""
    return LegProfile(
        name=LEGS,
        layout="table",
        baudrate=0,
        byte_order="little",
        legs=tuple(range(1, N_LEGS + 1)),
        counts_per_revolution=_DEGREES,
        zero_counts=(0.0,) * N_LEGS,
        sign=(1,) * N_LEGS,
        rate=rate,
    )


def _rate(t: Array) -> float:
    """Return the sampling rate, one over the median time step [Hz]."""
    return float(1 / np.median(np.diff(t)))


_IMU_MESSAGE: Final = "sensor_msgs/msg/Imu"
_FIELDS: Final = (
    ("orientation", "q", "wxyz"),
    ("angular_velocity", "rate_", "xyz"),
    ("linear_acceleration", "force_", "xyz"),
)


def read_imu_messages(
    path: Path, *, topic: str | None = None, topics: Collection[str] = ()
) -> tuple[RawTable, str]:
    """Read IMU messages of a ROS log as the columns of an IMU table, without what is damaged.

    Args:
        path: The log: MCAP or a bag.
        topic: Topic to read; None for one of `topics`, else the only one with IMU messages.
        topics: Topics to prefer, also such of other messages.

    Returns:
        `t` [s], the quaternion `qw` to `qz` [-], and where they are measured `rate_x` … [rad/s] and
        `force_x` … [m/s2]; and the topic.

    Raises:
        NotFound: The log does not exist, or the package that reads it.
        DataError: It cannot be read, has no such messages, or several topics and none is chosen, or
            the messages mark the orientation as not measured.
    """
    found = read_topic(path, (_IMU_MESSAGE,), what="IMU messages", topic=topic, topics=topics)
    columns = {"t": np.array(found.t)}
    with parsing(path, OTHER_FIELDS):
        for field, name, axes in _FIELDS:
            if not any(_absent(each, field) for each in found.contents):
                vectors = [getattr(message, field) for message in found.contents]
                columns |= {f"{name}{a}": np.array([getattr(v, a) for v in vectors]) for a in axes}
    if "qw" not in columns:
        raise DataError(
            f"has no orientation on topic {found.topic}: the first element of its covariance is "
            "-1; expected the orientation of the body: choose the topic of a filter that estimates "
            "it, such as imu_filter_madgwick",
            file=path,
        )
    series = {name: pd.Series(values) for name, values in columns.items()}
    told = f"{path.name}: {found.told}"
    return RawTable(path, series, notes=(told, *found.notes)), found.topic


def _absent(message: Any, field: str) -> bool:
    """Return whether an IMU message marks a field as not measured, by -1 as first covariance."""
    return getattr(message, f"{field}_covariance")[0] == -1
