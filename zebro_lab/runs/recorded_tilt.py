# SPDX-License-Identifier: MIT
"""Decode roll and pitch over time from the IMU of a recorded run."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.arrays import Array
from rig.clock_watch import sample_times
from rig.errors import RigError
from rig.imu.profile import decode_orientation, load_imu_profile
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.raw_log import raw_topic, read_raw_log
from zebro_lab.runs.folder import LOG_FILE
from zebro_lab.runs.manifest import profile_file, read_manifest
from zebro_lab.runs.profile_streams import IMU


@dataclass(frozen=True)
class Tilt:
    """Measured roll and pitch of the body over time.

    Attributes:
        t: Time since the start of the run, increasing, shape (n,) [s].
        angles: Roll and pitch, columns in this order, shape (n, 2) [rad].
        files: Files read: log and profile.
        source: Where the IMU's data come from, as in the run's manifest.
        notes: Of a run with several IMUs a note on which one this is.
    """

    t: Array
    angles: Array
    files: tuple[Path, ...]
    source: str
    notes: tuple[str, ...] = ()


def read_recorded_tilt(folder: Path) -> Tilt | None:
    """Read roll and pitch of a run; None without log, IMU profile or samples of an IMU.

    Of several IMUs (`imu1`, `imu2`, ...) the first that has a profile and samples is read. Samples
    whose time does not increase are dropped; a damaged log is read up to the damage.

    Raises:
        DataError: The log cannot be opened or is not MCAP, or the IMU's profile is invalid, or
            `run.json` is damaged.
    """
    log = folder / LOG_FILE
    names = sorted(file.stem for file in profile_file(folder, IMU).parent.glob(f"{IMU}*.toml"))
    if not names or not log.is_file():
        return None
    streams = read_raw_log(log).streams
    name = next((name for name in names if raw_topic(name) in streams), None)
    if name is None:
        return None
    stream = streams[raw_topic(name)]
    profile = profile_file(folder, name)
    try:
        decoded = decode_orientation(load_imu_profile(str(profile)), stream)
    except RigError as error:
        raise DataError(str(error), file=profile) from error
    t = sample_times(stream)
    later = np.r_[True, np.diff(np.maximum.accumulate(t)) > 0]
    angles = np.column_stack([decoded.roll, decoded.pitch])
    others = ", ".join(other for other in names if other != name)
    notes = (f"roll and pitch are those of {name}; not used: {others}",) if others else ()
    manifest = read_manifest(folder)
    source = manifest.sources.get(name, manifest.source)
    return Tilt(t[later], angles[later], (log, profile), source, notes)
