# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab import`: convert files from other software to a run folder."""

from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.format_distinct import format_distinct
from model.tasks import Watcher
from zebro_lab.exchange.import_request import FIRST, LAST, ImportRequest
from zebro_lab.exchange.imported_walk import ImportedWalk, read_imu_messages, write_imported_walk
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.names import is_ros_log
from zebro_lab.files.source_names import joined_source, stated_source
from zebro_lab.mcap.ros_log import bag_files
from zebro_lab.robot.imu_log import IMU_UNITS, ImuLog, imu_of_table
from zebro_lab.robot.leg_log import LEG_UNITS, LegLog
from zebro_lab.robot.leg_warnings import leg_warnings
from zebro_lab.robot.robot_file import RobotFile, read_robot_file
from zebro_lab.runs.legs import LegNames, legs_of_file, require_used
from zebro_lab.runs.manifest import IMPORTED, RunManifest, read_manifest
from zebro_lab.tables.columns import COLUMNS_FILE, IMU, LEGS, TRACK
from zebro_lab.tables.columns_file import read_mapped_columns
from zebro_lab.tables.columns_sections import columns_above
from zebro_lab.tables.table_files import read_table_file, table_stem
from zebro_lab.terminal.leg_options import joint_names
from zebro_lab.track.foreign import ForeignTrack, read_foreign_track
from zebro_lab.track.trajectory.request import TrajectoryRequest
from zebro_lab.track.trajectory.table import MAPPED_UNITS

_UNIX: Final = 1e9
"""First time that counts as Unix time, since no run lasts for 30 years [s]."""


@dataclass(frozen=True)
class Imported:
    """Result of an import.

    Attributes:
        folder: The run folder that was written.
        manifest: Its manifest.
        notes: Notes, one line each: on the start time, on damage and left-out rows, on leg angles
            that look wrong, and on columns or a source stated in a folder above a file's own.
    """

    folder: Path
    manifest: RunManifest
    notes: tuple[str, ...]


def import_run(request: ImportRequest, watcher: Watcher) -> Imported:
    """Convert files of a walk recorded by other software to a run folder.

    All files are read and checked before the folder is written.

    Args:
        request: Files to import and settings.
        watcher: Progress display.

    Returns:
        The run folder that was written, its manifest, and notes on how the files were read.

    Raises:
        SettingsError: An option, a `columns.toml` or the robot's file is invalid, or neither leg
            angles nor a track are given.
        NotFound: A file is missing.
        DataError: A file has invalid content, with file, column and row where there are such; or
            IMU or track share no time with the legs.
        AlreadyExists: The folder of the run exists.
        OSError: The folder cannot be written.
    """
    _require_something(request)
    watcher.step("reading", None)
    walk, notes = _walk(request)
    folder = write_imported_walk(request.data, walk)
    files = ((LEGS, request.legs), (IMU, request.imu), (TRACK, request.track))
    above = [  # notes on columns or a source that a columns.toml in a folder above states
        line for kind, file in files if file is not None
        for line in columns_above(kind, file, request.columns)
    ]  # fmt: skip
    return Imported(folder, read_manifest(folder), (*notes, *above))


def _require_something(request: ImportRequest) -> None:
    """Raise `SettingsError` if no file is given, or an option is given without its file."""
    legs, track = request.legs is not None, request.track is not None
    walk = "belongs to a walk; give the leg angles, too, with --legs"
    wrong = (
        (request.imu is not None and not legs, "--imu", walk),
        (request.robot is not None and not legs, "--robot", walk),
        (not legs and not track, "--legs, --track",
         "no file to import is given; add one of these"),
        (request.trajectory != TrajectoryRequest() and not track, "--track",
         "--plane, --forward, --times and --layout say how a track is read; add its file"),
        (request.pose_sd is not None and not track, "--track-sd",
         "is that of a track; add its file, with --track"),
        (request.track_offset and not (legs and track), "--track-offset",
         "brings a track to the clock of the legs; give the files of both"),
    )  # fmt: skip
    for is_wrong, key, problem in wrong:
        if is_wrong:
            raise SettingsError(problem, key=key)


def _walk(request: ImportRequest) -> tuple[ImportedWalk, tuple[str, ...]]:
    """Read and check all files of a request; return the walk and notes on how they were read.

    The run's time 0 is that of the legs' file, or of the track's if there are no legs, as `_start`
    finds it. The source of a track counts only where it stands alone.
    """
    robot = RobotFile() if request.robot is None else read_robot_file(request.robot)
    legs, legs_topic = (None, None) if request.legs is None else _legs(request.legs, request)
    track, track_topic = (None, None) if request.track is None else _track(request.track, request)
    imu, imu_topic = (None, None) if request.imu is None else _imu(request.imu, request)
    require_used(request.topic, (legs_topic, imu_topic, track_topic))
    parts = {LEGS: legs, IMU: imu, TRACK: track}
    t, file = next(_times(part) for part in (legs, track) if part is not None)
    start, zero, notes = _start(request.start, float(t[0]), float(t[-1]), file)
    for kind in (IMU, TRACK):
        if legs is not None and (part := parts[kind]) is not None:
            offset = request.track_offset if kind == TRACK else 0.0
            _require_shared_time(t, kind, *_times(part), offset)
    suspected: tuple[str, ...] = ()
    if legs is not None:
        suspected = leg_warnings(
            legs.reference,
            leg_sign=robot.leg_sign,
            leg_offset=robot.robot.leg_offset,
            columns=legs.columns_file,
        )
    notes = (*notes, *(legs.notes if legs else ()), *suspected, *(imu.notes if imu else ()))
    if track is not None:
        track = track.since(zero - request.track_offset)
        notes += track.track.notes
    stated = {LEGS: (legs and legs.source, request.legs), IMU: (imu and imu.source, request.imu)}
    if legs is None:
        stated = {TRACK: (track and track.track.source, request.track)}
    sources = {kind: stated_source(source, file) for kind, (source, file) in stated.items() if file}
    manifest = RunManifest(
        kind="walk",
        label=request.label or table_stem(file) or file.stem,
        material=request.material,
        operator=request.operator,
        source=joined_source(list(sources.values())),
        start=start.isoformat(),
        exit_status=IMPORTED,
        sources=sources,
    )
    return ImportedWalk(manifest, zero, legs, imu, track, robot, suspected), notes


def _times(part: LegLog | ImuLog | ForeignTrack) -> tuple[Array, Path]:
    """Return the times of a file's rows, in the file's time [s], and the file."""
    if isinstance(part, LegLog):
        return part.reference.t, part.files[0]
    if isinstance(part, ImuLog):
        return part.t, part.files[0]
    return part.track.poses.t, part.track.file


def _legs(path: Path, request: ImportRequest) -> tuple[LegLog, str | None]:
    """Read the leg angles; return them, and the topic that was read of a ROS log, else None."""
    mapping, topic = read_mapped_columns(LEGS, path, request.columns, LEG_UNITS)
    names = LegNames(joint_names(request.joints), request.topic, topic)
    return legs_of_file(path, mapping, names=names)


def _imu(path: Path, request: ImportRequest) -> tuple[ImuLog, str | None]:
    """Read the IMU; return it, and the topic that was read of a ROS log, else None."""
    series, topic = read_mapped_columns(IMU, path, request.columns, IMU_UNITS)
    if not is_ros_log(path):
        return imu_of_table(read_table_file(path, sheet=series.sheet), series), None
    table, topic = read_imu_messages(path, topic=topic, topics=request.topic)
    imu = imu_of_table(table, series)
    return replace(imu, files=(*bag_files(path), *imu.files[1:])), topic


def _track(path: Path, request: ImportRequest) -> tuple[ForeignTrack, str | None]:
    """Read the track; return it, and the topic that was read of a ROS log, else None."""
    alone = request.legs is None
    columns, topic = read_mapped_columns(TRACK, path, request.columns, MAPPED_UNITS, alone=alone)
    track = read_foreign_track(
        path, columns, request.trajectory, topic=topic, topics=request.topic,
        sd=request.pose_sd,
    )  # fmt: skip
    return track, track.topic


def _start(
    given: datetime | None, first: float, last: float, file: Path
) -> tuple[datetime, float, tuple[str, ...]]:
    """Return the start date of a run, the files' time at that date [s], and notes.

    The date is `given`, for time 0; else `first`, the first time in `file` [s], as Unix time if
    it is `_UNIX` or later; else now, for time 0.

    Raises:
        SettingsError: A date is given, but `first` is a Unix time.
        DataError: The run would end, with the time `last` [s], after `LAST`.
    """
    is_unix = first >= _UNIX
    start = FIRST if is_unix else given or datetime.now(UTC)
    if start.timestamp() + last >= LAST.timestamp():
        raise DataError(
            f"times go from {first:.10g} to {last:.10g} s, which is beyond {LAST:%Y-%m-%d}, the "
            "last day that a log can hold; expected seconds from 0 or since 1970: correct them, or "
            "state their unit in columns.toml",
            file=file,
        )
    began = FIRST + timedelta(seconds=first)
    if given is not None and is_unix:
        raise SettingsError(
            f"times in the file are seconds since 1970 already: the first is {began.isoformat()}; "
            "leave out --start, or count times from 0; to state instead when the clock of a track "
            f"was 0, add --track-offset {given.timestamp():.3f}",
            key="--start",
        )
    if given is not None:
        return given.astimezone(UTC), 0.0, ()
    if is_unix:
        return began, first, (f"times are read as Unix time: the run starts {began.isoformat()}",)
    note = f"the date of the recording is not known; time 0 is set to now, {start.isoformat()}"
    return start, 0.0, (f"{note} (give the date with --start)",)


def _require_shared_time(t: Array, kind: str, times: Array, file: Path, offset: float) -> None:
    """Raise `DataError` if no row of IMU or track lies within the time of the leg log.

    Args:
        t: Times of the leg log, as in its file [s].
        kind: Kind of the other file.
        times: Times of its rows [s].
        file: The other file.
        offset: Time that is added to them [s].
    """
    if np.any((times + offset >= t[0]) & (times + offset <= t[-1])):
        return
    first, last, start, end = format_distinct(*times[[0, -1]] + offset, *t[[0, -1]])
    later = f"{t[0] - times[0]:.3f}".rstrip("0").rstrip(".")
    stated = f"state offset = {later} in [{IMU}.columns.t] of {COLUMNS_FILE}"
    advice = f"add --track-offset {later}" if kind == TRACK else stated
    raise DataError(
        f"times of the {kind} go from {first} to {last} s, those of the legs from {start} to "
        f"{end} s: no second is shared; {advice} where both start together, or bring both files to "
        "one clock",
        file=file,
    )
