# SPDX-License-Identifier: MIT
"""Write an imported walk as a run folder."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Final

import numpy as np

from model.robot import N_LEGS
from model.slip.law import Array
from rig.device import Counters, Sample
from rig.imu.profile import load_imu_profile, render_table_profile
from rig.zebro.profile import LegProfile, load_leg_profile, render_leg_profile
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.provenance import file_hash, file_hashes
from zebro_lab.files.source_names import stated_source
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.stream_views import ImuView, LegsView, StreamView
from zebro_lab.robot.imu_log import ImuLog
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.robot.robot_file import ROBOT_FILE, RobotFile
from zebro_lab.runs.folder import (
    IMPORTED,
    LOG_FILE,
    RunManifest,
    epoch_ns,
    finished_run_folder,
    write_manifest,
)
from zebro_lab.runs.manifest import TABLE, profile_file, software_version
from zebro_lab.runs.recorded_legs import LEGS
from zebro_lab.track.folder import track_folder
from zebro_lab.track.foreign import ForeignTrack

IMU: Final = "imu"
TRACK: Final = "track"
_DEGREES: Final = 360
"""Counts per revolution in the profile of imported angles: they are stored in degrees."""
_BATCH: Final = 100
"""Number of samples per message."""


@dataclass(frozen=True)
class ImportedWalk:
    """Data of an imported walk.

    Attributes:
        label: Name of the run.
        source: "real", "sim:what", "replay:what" or "import:FILE".
        start: Date of time 0, with its time zone.
        zero: Time of the files at which the run began [s].
        legs: Leg angles.
        imu: Orientation of the body.
        track: Its tracked path; None without one.
        robot: The robot; the thesis's robot without a file.
        material: Leg and ground material.
        operator: Name of the operator.
    """

    label: str
    source: str
    start: datetime
    zero: float
    legs: LegLog
    imu: ImuLog | None
    track: ForeignTrack | None
    robot: RobotFile
    material: str
    operator: str

    @property
    def files(self) -> tuple[Path, ...]:
        """Every file that was read."""
        parts = (self.legs.files, self.imu and self.imu.files, self.track and self.track.files)
        robot = (self.robot.file,) if self.robot.file else ()
        return tuple(dict.fromkeys([f for part in parts if part for f in part] + list(robot)))


@dataclass(frozen=True)
class _Stream:
    view: StreamView
    profile: str
    samples: list[Sample]


def write_imported_walk(data_dir: Path, walk: ImportedWalk) -> Path:
    """Write a run folder: log, profiles, manifest, and the track if there is one.

    Args:
        data_dir: Folder of run folders; made when missing.
        walk: The walk.

    Returns:
        The run folder.

    Raises:
        AlreadyExists: A run with this start and label exists.
    """
    inputs = file_hashes(walk.files)
    with finished_run_folder(data_dir, kind="walk", label=walk.label, start=walk.start) as (
        folder,
        draft,
    ):
        streams = _streams(draft, walk)
        _write_log(draft, walk, streams)
        if walk.robot.file is not None:
            atomic_write_text(draft / ROBOT_FILE, walk.robot.file.read_text(encoding="utf-8-sig"))
        if walk.track is not None:
            _write_track(draft / TRACK, walk, walk.track)
        write_manifest(draft, _manifest(draft, walk, streams, inputs))
    return folder


def _streams(draft: Path, walk: ImportedWalk) -> Mapping[str, _Stream]:
    """Write the profiles and encode the samples of all streams."""
    t, theta = walk.legs.reference.t - walk.zero, walk.legs.reference.theta
    texts = {LEGS: render_leg_profile(_leg_profile(_rate(t)))}
    if walk.imu is not None:
        texts[IMU] = render_table_profile(_rate(walk.imu.t))
    for name, text in texts.items():
        profile_file(draft, name).parent.mkdir(exist_ok=True)
        atomic_write_text(profile_file(draft, name), text)
    legs = LegsView(LEGS, profile=load_leg_profile(str(profile_file(draft, LEGS))))
    streams = {LEGS: _Stream(legs, texts[LEGS], _samples(t, np.degrees(theta)))}
    if walk.imu is not None:
        view = ImuView(IMU, profile=load_imu_profile(str(profile_file(draft, IMU))))
        samples = _samples(walk.imu.t - walk.zero, walk.imu.values)
        streams[IMU] = _Stream(view, texts[IMU], samples)
    return streams


def _leg_profile(rate: float) -> LegProfile:
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


def _samples(t: Array, values: Array) -> list[Sample]:
    return [
        Sample(host, None, None, tuple(row))
        for host, row in zip(t.tolist(), values.tolist(), strict=True)
    ]


def _write_log(draft: Path, walk: ImportedWalk, streams: Mapping[str, _Stream]) -> None:
    with (draft / LOG_FILE).open("wb") as file:
        log = LogWriter(
            file,
            views={name: stream.view for name, stream in streams.items()},
            attachments={f"profiles/{name}.toml": s.profile for name, s in streams.items()},
            start=0.0,
            start_ns=epoch_ns(walk.start),
        )
        log.event(0.0, f"imported, source {walk.source}")
        for name, part in _batches(streams):
            log.write(name, part)
        log.finish()


def _batches(streams: Mapping[str, _Stream]) -> list[tuple[str, list[Sample]]]:
    """Split all streams into batches, in time order."""
    batches = [
        (name, stream.samples[first : first + _BATCH])
        for name, stream in streams.items()
        for first in range(0, len(stream.samples), _BATCH)
    ]
    return sorted(batches, key=lambda batch: batch[1][-1].host_time)


def _write_track(out: Path, walk: ImportedWalk, track: ForeignTrack) -> None:
    report = {"notes": list(track.track.notes), "tracked": len(track.track.poses)}
    with track_folder(
        out,
        track,
        source=track.track.source,
        settings={"imported": str(track.track.file), "zero_s": walk.zero},
        inputs=file_hashes(track.files),
        report=report,
    ):
        pass  # pictures would be added here; there are no photographs


def _manifest(
    draft: Path, walk: ImportedWalk, streams: Mapping[str, _Stream], inputs: Mapping[str, str]
) -> RunManifest:
    counts = {name: len(stream.samples) for name, stream in streams.items()}
    lasted = timedelta(seconds=max(s.samples[-1].host_time for s in streams.values()))
    return RunManifest(
        kind="walk",
        label=walk.label,
        material=walk.material,
        operator=walk.operator,
        source=walk.source,
        start=walk.start.isoformat(),
        stop=(walk.start + lasted).isoformat(),
        exit_status=IMPORTED,
        software=software_version(),
        constants={},
        streams={f"/{name}/raw": count for name, count in counts.items()},
        log_sha256=file_hash(draft / LOG_FILE),
        profiles=dict.fromkeys(streams, TABLE),
        sources={name: _source_of(name, walk) for name in streams},
        counters={n: asdict(Counters(received=c)) | {"dropped": 0} for n, c in counts.items()},
        robot=None if walk.robot.file is None else walk.robot.file.stem,
        inputs=inputs,
    )


def _source_of(name: str, walk: ImportedWalk) -> str:
    if name == IMU and walk.imu is not None:
        return stated_source(walk.imu.source, walk.imu.files[0])
    return stated_source(walk.legs.source, walk.legs.files[0])


def _rate(t: Array) -> float:
    return float(1 / np.median(np.diff(t)))
