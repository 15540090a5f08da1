# SPDX-License-Identifier: MIT
"""Decode the leg angles of a recorded run to a table."""

from pathlib import Path

import numpy as np
import pandas as pd

from rig.clock_watch import sample_times
from rig.errors import RigError
from rig.sample_columns import SampleColumns
from rig.zebro.profile import decode_angles, load_leg_profile
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.mcap.raw_log import raw_topic, read_raw_log
from zebro_lab.runs.folder import LOG_FILE, require_recorded
from zebro_lab.runs.manifest import MANIFEST_FILE, profile_file, read_manifest
from zebro_lab.tables.raw_table import RawTable

LEGS = "legs"
TRACK_ALONE = "holds a track without leg angles; import it again with its leg log, with --legs"


def is_recorded(path: Path) -> bool:
    """Return whether a path is a run folder: a folder with a `run.json`."""
    return (path / MANIFEST_FILE).is_file()


def read_recorded_legs(folder: Path) -> tuple[RawTable, tuple[Path, ...]]:
    """Read leg angles of a run: `t` [s] and `theta1` to `theta6` [rad], unwrapped.

    Samples whose time does not increase are dropped. A damaged log is read up to the damage, with a
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


def _angles(stream: SampleColumns, profile_path: Path) -> dict[str, np.ndarray]:
    try:
        angles = decode_angles(load_leg_profile(str(profile_path)), stream)
    except RigError as error:
        raise DataError(str(error), file=profile_path) from error
    t = sample_times(stream)
    later = np.r_[True, np.diff(np.maximum.accumulate(t)) > 0]
    columns = {"t": t[later]}
    for column, leg in enumerate(angles.legs):
        columns[f"theta{leg}"] = angles.theta[later, column]
    return columns
