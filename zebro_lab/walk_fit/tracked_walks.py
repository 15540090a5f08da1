# SPDX-License-Identifier: MIT
"""Read tracked walks from run folders, or from folders with a leg log and a track."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from model.format_distinct import format_distinct
from model.gait.inexact_log import InexactLog
from model.gait.reference import SampledReference
from model.walk_fit.tilt import FEWEST, TIME, MeasuredTilt
from model.walk_fit.tracked_walk import FEWEST_POSES, TrackedWalk
from zebro_lab.calibration.walks_folder import describe_legs
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.files.names import TRACK, numbered
from zebro_lab.files.replacement import recover
from zebro_lab.robot.leg_warnings import leg_warnings
from zebro_lab.robot.robot_file import ROBOT_FILE, RobotFile, read_robot_file
from zebro_lab.runs.counted_once import array_hash, duplicates_note, first_of_each
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.recorded_walk import is_recorded, read_recorded_tilt
from zebro_lab.tables.table_files import TABLE_SUFFIXES
from zebro_lab.track.file import TrackFile, read_track
from zebro_lab.track.folder import TRACK_CSV
from zebro_lab.track.foreign import ADVICE
from zebro_lab.validation.shared_clock import shifted
from zebro_lab.walk.leg_angles import angles_from
from zebro_lab.walk_fit.clocks import Clock

LEGS = tuple(f"legs{suffix}" for suffix in TABLE_SUFFIXES)


@dataclass(frozen=True)
class WalkOnFile:
    """A tracked walk as read from files.

    Attributes:
        name: Name of the folder of the walk, with a number if other walks have the same.
        robot: Parameters of the robot that walked.
        legs: Leg angles from time zero on.
        track: The track, in the same time base; poses outside the log's time range are dropped.
        source: Source of leg log and track; both, joined by a comma, if they differ.
        files: Every file read, those of the leg log first.
        notes: Notes, one line each.
        tilt: Roll and pitch from the run's IMU, in the same time base; None without an IMU or with
            too few data.
    """

    name: str
    robot: RobotFile
    legs: SampledReference | InexactLog
    track: TrackFile
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...]
    tilt: MeasuredTilt | None = None

    @property
    def tracked(self) -> TrackedWalk:
        """The walk as input of a fit: leg angles, tracked poses with covariance, roll and pitch."""
        poses = self.track.poses
        states = np.column_stack([poses.position, poses.yaw])
        return TrackedWalk(self.name, self.legs, poses.t, states, self.track.joint, self.tilt)

    @property
    def duration(self) -> float:
        """Duration of the leg log [s]."""
        return float(self.legs.t[-1])


def read_walks(folders: Sequence[Path], *, clock: Clock | None = None) -> list[WalkOnFile]:
    """Read tracked walks of one robot, at least one; equal folder names get a number.

    Excluded runs, and copies of other walks, are left out, with a note on the first walk.

    Args:
        folders: Folder of each walk, one or more, as for `read_walk_on_file`.
        clock: Shifts each track to the clock of its leg log; None to keep the track's times.

    Raises:
        ZebroLabError: As in `read_walk_on_file`; or the walks are of two robots, or all excluded.
    """
    excluded = {each: why for each in folders if (why := _exclusion(each)) is not None}
    skipped = tuple(f"left out, {folder}: {why}" for folder, why in excluded.items())
    counted = [each for each in folders if each not in excluded]
    if not counted:
        raise DataError(f"no walk to fit: {'; '.join(skipped)}")
    read = [read_walk_on_file(folder, clock=clock) for folder in counted]
    for walk in read[1:]:
        if describe_legs(walk.robot) != describe_legs(read[0].robot):
            raise SettingsError(
                f"{walk.name} was walked by another robot than {read[0].name}; calibrate with the "
                "walks of one robot at a time, or put one robot.toml into all folders",
                file=walk.robot.file,
            )
    walks, repeated = first_of_each(read, key=_content)
    duplicates = duplicates_note("walks", [(one.name, other.name) for one, other in repeated])
    walks[0] = replace(walks[0], notes=(*walks[0].notes, *skipped, *duplicates))
    names = numbered([walk.name for walk in walks])
    return [replace(walk, name=name) for walk, name in zip(walks, names, strict=True)]


def _exclusion(folder: Path) -> str | None:
    """Return why a run is excluded from calibrations; None if it is not, or is no run folder."""
    excluded = read_manifest(folder).excluded if is_recorded(folder) else None
    return None if excluded is None else f"excluded, {excluded.get('why', 'no reason given')}"


def _content(walk: WalkOnFile) -> str:
    """Return a hash of a walk's leg angles and track, by which copies are recognised."""
    poses = walk.track.poses
    return array_hash(walk.legs.theta, poses.position, poses.yaw)


def read_walk_on_file(folder: Path, *, clock: Clock | None = None) -> WalkOnFile:
    """Read leg angles, track, robot and IMU tilt of a tracked walk.

    Args:
        folder: A run folder, or one with a leg log such as `legs.csv`; with `track/track.csv` and
            optionally a `robot.toml` (else the thesis's robot) in it.
        clock: Shifts the track to the leg log's clock; None to keep the track's times.

    Raises:
        NotFound: There is no leg log, or no track.
        SettingsError: The `robot.toml` or a `columns.toml` is invalid.
        DataError: A file cannot be read, the track has no headings or no positive definite
            covariance, fewer than `FEWEST_POSES` of its poses lie within the log's time range, or
            `clock` rejects it.
    """
    log_file = _legs_of(folder)
    track_file = recover(folder / TRACK) / TRACK_CSV
    if not track_file.is_file():
        raise NotFound(f"{folder}: no track; zebro-lab track --out {folder / TRACK} makes one")
    own = folder / ROBOT_FILE
    described = read_robot_file(own) if own.is_file() else RobotFile()
    log = read_leg_log(log_file, leg_sign=described.leg_sign)
    start = float(log.reference.t[0])
    suspected = leg_warnings(
        log.reference, leg_offset=described.robot.leg_offset, columns=log.columns_file
    )
    legs, counted = angles_from(log, start)
    track = shifted(read_track(track_file), -start)
    track = track if clock is None else clock(track, legs, described.robot)
    inside, notes = _inside(float(legs.t[-1]), track)
    _require_states(inside)
    tilt, imu_files, imu_notes = _tilt(folder, start, float(log.reference.t[-1]))
    sources = sorted({log.source, track.source})
    return WalkOnFile(
        name=folder.absolute().name,
        robot=described,
        legs=legs,
        track=inside,
        source=", ".join(sources),
        files=(*log.files, track.file, *([described.file] if described.file else []), *imu_files),
        notes=(*log.notes, *suspected, *counted, *track.notes, *notes, *imu_notes),
        tilt=tilt,
    )


def _tilt(
    folder: Path, start: float, end: float
) -> tuple[MeasuredTilt | None, tuple[Path, ...], tuple[str, ...]]:
    """Read roll and pitch of a run's IMU from `start` to `end` [s], with time zero at `start`.

    Returns:
        Roll and pitch, None without an IMU or with less than 1 s of data; the files they were read
        from; and notes.
    """
    measured = read_recorded_tilt(folder) if is_recorded(folder) else None
    if measured is None:
        return None, (), ()
    inside = (measured.t >= start) & (measured.t <= end)
    if not inside.any() or np.ptp(measured.t[inside]) < FEWEST * TIME:
        note = f"roll and pitch are not used: under 1 s of IMU data at {start:g} to {end:g} s"
        return None, (), (note,)
    seen = MeasuredTilt(measured.t[inside] - start, measured.angles[inside])
    note = "roll and pitch of the IMU inform which leg is mounted wrong"
    return seen, measured.files, (note, *measured.notes)


def _legs_of(folder: Path) -> Path:
    """Return what leg angles are read from: a recorded run itself, else a file `legs.*` in it.

    Raises:
        NotFound: There is no such folder, or no leg angles in it.
    """
    if not folder.is_dir():
        raise NotFound(f"{folder}: no such folder; expected a run with leg angles and a track")
    if is_recorded(folder):
        return folder
    for name in LEGS:
        if (folder / name).is_file():
            return folder / name
    raise NotFound(
        f"{folder}: no leg angles; expected a recorded run, or a folder with {LEGS[0]} and "
        f"{TRACK}/{TRACK_CSV}"
    )


def _inside(end: float, track: TrackFile) -> tuple[TrackFile, tuple[str, ...]]:
    """Drop the poses outside the leg log's time range, zero to `end` [s]; also return notes.

    Raises `DataError` if fewer than `FEWEST_POSES` are left.
    """
    t = track.poses.t
    keep = (t >= 0) & (t <= end)
    if keep.sum() < FEWEST_POSES:
        first, last, until = format_distinct(t[0], t[-1], end)
        raise DataError(
            f"{keep.sum()} of {len(t)} poses, from {first} to {last} s after the leg log's "
            f"first sample, lie within its {until} s; expected {FEWEST_POSES} or more: do both "
            "keep the same clock? If not, --estimate-offset may find how far they are apart",
            file=track.file,
        )
    left_out = int((~keep).sum())
    notes = (f"{left_out} poses outside the leg log's time are not used",) if left_out else ()
    part = replace(track, poses=track.poses.part(keep))
    return part, notes


def _require_states(track: TrackFile) -> None:
    """Raise `DataError` unless a track has headings and positive definite covariances."""
    if not track.poses.has_yaw:
        raise DataError("has no headings (yaw_rad), which a fit of walks needs", file=track.file)
    if not np.all(np.linalg.eigvalsh(track.covariance) > 0):
        raise DataError(
            "has no covariance, or a singular one (a variance of 0); a fit of walks needs columns "
            "cov_xx, cov_xy, cov_xyaw, cov_yy, cov_yyaw, cov_yawyaw, positive definite: "
            f"{ADVICE}",
            file=track.file,
        )
