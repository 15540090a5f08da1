# SPDX-License-Identifier: MIT
"""Decode leg angles, and roll and pitch of the body, of a recorded run."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from rig.clock_watch import sample_times
from rig.errors import RigError
from rig.imu.profile import decode_orientation, load_imu_profile
from rig.sample_columns import SampleColumns
from rig.zebro.profile import decode_angles, load_leg_profile
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.mcap.raw_log import raw_topic, read_raw_log
from zebro_lab.runs.folder import LOG_FILE, require_profiles, require_recorded
from zebro_lab.runs.manifest import MANIFEST_FILE, profile_file, read_manifest
from zebro_lab.runs.profile_streams import IMU, LEGS
from zebro_lab.tables.raw_table import RawTable

TRACK_ALONE = "holds a track without leg angles; import it again with its leg log, with --legs"


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


def is_recorded(path: Path) -> bool:
    """Return whether a path is a run folder: a folder with a `run.json`."""
    return (path / MANIFEST_FILE).is_file()


def read_recorded_legs(folder: Path) -> tuple[RawTable, tuple[Path, ...]]:
    """Read leg angles of a run: `t` [s] and `theta1` to `theta6` [rad], unwrapped.

    Samples whose time does not increase are dropped. A damaged log is read without that, with a
    note, and its checksum is not compared. Legs that the profile lacks have no column.

    Args:
        folder: The run folder.

    Returns:
        The angles as a table, and the files read: log, profile and manifest.

    Raises:
        NotFound: Manifest, log or profile is missing.
        DataError: Manifest or profile is invalid, the log is not MCAP or has another checksum than
            the manifest, its samples do not fit the profile, or no legs were recorded or imported.
    """
    manifest = read_manifest(folder)
    if manifest.is_track_alone:
        raise DataError(f"{folder}: {TRACK_ALONE}")
    require_profiles(folder, manifest)
    log, profile = folder / LOG_FILE, profile_file(folder, LEGS)
    for file in (log, profile):
        if not file.is_file():
            raise NotFound(f"{file}: missing; restore it, or give a run with recorded leg angles")
    raw = read_raw_log(log)
    stream = raw.streams.get(raw_topic(LEGS))
    if stream is None:
        raise DataError(f"has no leg angles: no samples of topic {raw_topic(LEGS)}", file=log)
    notes = ()
    if raw.damage is None:
        require_recorded(log, manifest)
    else:
        notes = (f"{folder.name}: {LOG_FILE} is incomplete ({raw.damage})",)
    columns = {name: pd.Series(values) for name, values in _angles(stream, profile).items()}
    source = manifest.sources.get(LEGS, manifest.source)
    table = RawTable(log, columns, source=source, notes=notes)
    return table, (log, profile, folder / MANIFEST_FILE)


def read_recorded_tilt(folder: Path) -> Tilt | None:
    """Read roll and pitch of a run; None without log, IMU profile or samples of an IMU.

    Of several IMUs (`imu1`, `imu2`, ...) the first that has a profile and samples is read. Samples
    whose time does not increase are dropped; a damaged log is read without that, and the log's
    checksum is not compared.

    Raises:
        NotFound: `run.json` is missing.
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
    with _decoding(profile):
        decoded = decode_orientation(load_imu_profile(str(profile)), stream)
    t, later = _increasing_times(stream)
    angles = np.column_stack([decoded.roll, decoded.pitch])[later]
    others = ", ".join(other for other in names if other != name)
    notes = (f"roll and pitch are those of {name}; not used: {others}",) if others else ()
    manifest = read_manifest(folder)
    source = manifest.sources.get(name, manifest.source)
    return Tilt(t, angles, (log, profile), source, notes)


def _angles(stream: SampleColumns, profile: Path) -> dict[str, Array]:
    """Decode `t` [s] and `theta1` … [rad] of the profile's legs, at increasing times only."""
    with _decoding(profile):
        angles = decode_angles(load_leg_profile(str(profile)), stream)
    t, later = _increasing_times(stream)
    theta = dict(zip(angles.legs, angles.theta[later].T, strict=True))
    return {"t": t, **{f"theta{leg}": values for leg, values in theta.items()}}


@contextmanager
def _decoding(profile: Path) -> Iterator[None]:
    """Convert a `RigError` of the body, which decodes with a profile, to a `DataError`."""
    try:
        yield
    except RigError as error:
        raise DataError(str(error), file=profile) from error


def _increasing_times(stream: SampleColumns) -> tuple[Array, NDArray[np.bool_]]:
    """Return the times of the samples that are later than all before [s], and a mask of these."""
    t = sample_times(stream)
    later = np.r_[True, np.diff(np.maximum.accumulate(t)) > 0]
    return t[later], later
