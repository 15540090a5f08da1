# SPDX-License-Identifier: MIT
"""Open runs and devices, and report on runs, for notebooks."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.names import TRACK
from zebro_lab.front.defaults import PathLike
from zebro_lab.recording.devices import DevicesRequest, OpenDevices
from zebro_lab.recording.devices import open_devices as open_devices_of
from zebro_lab.report.request import ReportRequest
from zebro_lab.report.stage import report
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import RunManifest, read_manifest
from zebro_lab.track.file import TrackFile, read_track


@dataclass(frozen=True)
class Run:
    """A recorded or imported run.

    Attributes:
        folder: The run folder.
        manifest: Content of `run.json`.
    """

    folder: Path
    manifest: RunManifest

    def legs(self) -> LegLog:
        """Read the leg angles over time, decoded from the counts of a recorded run.

        Leg signs of a `robot.toml` are not applied.

        Raises:
            ZebroLabError: The run has no leg angles, or they cannot be read.
        """
        return read_leg_log(self.folder)

    def rig_data(self) -> RigData:
        """Read the samples of a slip-rig run.

        Raises:
            ZebroLabError: The run is of another kind, excluded, cannot be read, or its samples are
                too few or of one slip ratio.
        """
        return read_rig_data([self.folder])

    def track(self) -> TrackFile:
        """Read the tracked poses from the folder `track` of the run.

        Raises:
            ZebroLabError: The run has no track, or the track cannot be read.
        """
        return read_track(self.folder / TRACK)


def open_run(folder: PathLike) -> Run:
    """Open a recorded or imported run.

    Args:
        folder: The run folder.

    Raises:
        ZebroLabError: The folder is not a run, or its manifest is damaged.
    """
    return Run(Path(folder), read_manifest(Path(folder)))


@contextmanager
def open_devices(
    *, zebro: str | None = None, imus: Sequence[str] = (), rig: str | None = None, seed: int = 0
) -> Iterator[OpenDevices]:
    """Open devices, real or simulated; leaving the context de-energises what they drive.

    Args:
        zebro: Robot as "PROFILE@PORT", "PROFILE@sim", "sim" or "replay:RUN"; None for no robot.
        imus: Inertial measurement units, each in the same form.
        rig: Slip rig in the same form; None for no rig.
        seed: Seed of the random numbers of simulated devices.

    Yields:
        The devices, their drivers connected.

    Raises:
        SettingsError: No device is named.
        RigError: An address or a profile is invalid, or a port cannot be opened.
        ZebroLabError: A run to replay cannot be read.
    """
    request = DevicesRequest(zebro=zebro, imus=tuple(imus), rig=rig, seed=seed)
    with open_devices_of(request) as devices:
        yield devices


def write_report(
    data: PathLike, *, out: PathLike, calibration: PathLike | None = None, title: str | None = None
) -> Path:
    """Write an HTML report of one or several runs from their result folders.

    Args:
        data: A run folder, or a folder of them.
        out: HTML file to write.
        calibration: Calibration folder, which need not exist; None for `calibration` beside `data`.
        title: Title of the page; None for "Report on" and the name of the folder `data`.

    Returns:
        The file written.

    Raises:
        ZebroLabError: There is nothing to report on, a file of a result is missing or damaged, or
            `out` exists and is no report, or its folder does not exist.
    """
    folder = Path(data).absolute().parent / "calibration" if calibration is None else calibration
    report(ReportRequest(Path(data), Path(folder), Path(out), title), made=datetime.now(UTC))
    return Path(out)
