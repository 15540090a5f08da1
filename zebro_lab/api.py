# SPDX-License-Identifier: MIT
"""The functions that a notebook or script needs; `import zebro_lab as zl` offers them.

Paths may be strings. Functions that write a folder do so atomically, as the commands do, and raise
if the folder is the result of another command. Without `out` no files are kept.
"""

import io
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, TypeAlias

from model.bayes.calibration import Calibration
from model.bayes.verdict import Verdict
from model.gait.direction import Direction
from model.poses import Poses
from model.progress import Watcher
from model.slip.curve import SlipCurve
from model.walk.path import WalkPath
from zebro_lab.calibration import folder as calibration_folder
from zebro_lab.calibration import stage as calibration_stage
from zebro_lab.calibration.rig_data import RigData
from zebro_lab.calibration.rig_data import read_rig_data as read_rig_files
from zebro_lab.recording.devices import DevicesRequest, OpenDevices
from zebro_lab.recording.devices import open_devices as open_devices_of
from zebro_lab.report.stage import ReportRequest, report
from zebro_lab.robot.gait_argument import GaitRequest
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.runs.folder import read_manifest
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import RunManifest
from zebro_lab.track.file import TrackFile
from zebro_lab.track.file import read_track as read_track_file
from zebro_lab.track.photo_sequence import TimeRequest
from zebro_lab.track.request import TrackRequest
from zebro_lab.track.stage import TrackResult, track
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.validation.stage import Validated, ValidateRequest, validate
from zebro_lab.walk.path_band import BandRequest, read_draws
from zebro_lab.walk.predict_stage import PredictRequest, predict
from zebro_lab.walk.stage import WalkRequest, walk
from zebro_lab.walk.walking import ModelRequest, Walked

if TYPE_CHECKING:
    import arviz as az
    import pandas as pd

    from tracking.composite import Merged

PathLike: TypeAlias = str | os.PathLike[str]

__all__ = [
    "CalibrationResult",
    "Run",
    "WalkResult",
    "calibrate",
    "open_devices",
    "open_run",
    "predict_walk",
    "read_legs",
    "read_rig_data",
    "read_slip_curve",
    "read_track",
    "track_photos",
    "validate_walks",
    "walk_gait",
    "write_report",
]


class Silent:
    """A watcher that shows no progress and never asks to stop."""

    def step(self, what: str, fraction: float | None) -> None:
        """Ignore a progress report.

        Args:
            what: Name of the task.
            fraction: Share of the task that is done, 0 to 1 [-]; None when unknown.
        """

    def stop_requested(self) -> bool:
        """Return False."""
        return False


@dataclass(frozen=True)
class CalibrationResult:
    """A finished calibration.

    Attributes:
        calibration: Everything that the fit concluded.
        data: The rig data that it was made from.
        curve: The slip curve, as `slip.toml` keeps it.
    """

    calibration: Calibration
    data: RigData
    curve: SlipCurve

    @property
    def verdict(self) -> Verdict:
        """Whether the fit converged and can be trusted, and what to do next."""
        return self.calibration.verdict

    @property
    def summary(self) -> "pd.DataFrame":
        """Posterior of each parameter with its diagnostics, one row each, SI units."""
        import pandas as pd

        table = calibration_folder.summary_csv(self.calibration)
        return pd.read_csv(io.StringIO(table), index_col="parameter")

    @property
    def posterior(self) -> "az.InferenceData":
        """Posterior draws and observed block means; a chain is an ensemble of walkers."""
        return calibration_folder.inference_data(self.calibration)


@dataclass(frozen=True)
class WalkResult:
    """A walk, or a predicted walk.

    Attributes:
        walk: Body, legs, slip and forces over time.
        draws: Paths with the unknowns drawn; None unless draws were asked for.
        notes: Notes, one line each.
    """

    walk: WalkPath
    draws: Poses | None
    notes: tuple[str, ...]

    @property
    def path(self) -> Poses:
        """The body's path over the ground."""
        return self.walk.poses


@dataclass(frozen=True)
class Run:
    """A recorded or imported run.

    Attributes:
        folder: Its folder.
        manifest: What `run.json` says.
    """

    folder: Path
    manifest: RunManifest

    def legs(self) -> LegLog:
        """Read the leg angles over time.

        Raises:
            ZebroLabError: The run has none, or they cannot be read.
        """
        return read_leg_log(self.folder)

    def rig_data(self) -> RigData:
        """Read the samples of a slip-rig run.

        Raises:
            ZebroLabError: The run is of another kind, or cannot be read.
        """
        return read_rig_files([self.folder])

    def track(self) -> TrackFile:
        """Read the tracked poses.

        Raises:
            ZebroLabError: The run has no track, or it cannot be read.
        """
        return read_track_file(self.folder / "track")


def read_rig_data(
    *data: PathLike, columns: PathLike | None = None, slip_definition: str | None = None
) -> RigData:
    """Read rig experiments from tables, run folders or folders of either.

    Args:
        data: Files and folders.
        columns: A `columns.toml` for tables that have none beside them.
        slip_definition: Definition to convert slip ratios to; that of the data when None.

    Returns:
        Samples in SI with their source, the files read, and notes.

    Raises:
        ZebroLabError: A file is missing or cannot be used; names file, row and column.
    """
    return read_rig_files(
        [Path(each) for each in data], columns=_path(columns), slip_definition=slip_definition
    )


def calibrate(
    *data: PathLike,
    out: PathLike | None = None,
    columns: PathLike | None = None,
    slip_definition: str | None = None,
    law: str = "magic-formula",
    ensembles: int = 4,
    max_steps: int = 30_000,
    seed: int = 1,
    watcher: Watcher | None = None,
) -> CalibrationResult:
    """Fit a slip law to rig data by Bayesian inference, as `calibrate-slip` does.

    Args:
        data: Files and folders of rig data.
        out: Calibration folder to write; None to keep no files.
        columns: A `columns.toml` for tables that have none beside them.
        slip_definition: Definition of the slip ratio to fit in; that of the data when None.
        law: "magic-formula", "brush" or "coulomb-stribeck".
        ensembles: Independent ensembles of walkers.
        max_steps: Sampler moves after which a fit that has not converged ends as such.
        seed: Seed of all random numbers.
        watcher: Follows the progress and may ask to stop.

    Raises:
        ZebroLabError: The data cannot be used.
        ModelError: The fit failed.
    """
    with _folder(out) as folder:
        request = calibration_stage.CalibrationRequest(
            data=tuple(Path(each) for each in data),
            out=folder,
            columns=_path(columns),
            slip_definition=slip_definition,
            law=law,
            ensembles=ensembles,
            max_steps=max_steps,
            seed=seed,
        )
        found, rig_data = calibration_stage.calibrate(request, watcher or Silent())
        return CalibrationResult(found, rig_data, calibration_folder.read_slip(folder))


def read_slip_curve(path: PathLike) -> SlipCurve:
    """Read the slip curve of a calibration.

    Args:
        path: A `slip.toml`, or the folder that holds it.

    Raises:
        DataError: It is missing, damaged, or of a later schema.
    """
    return calibration_folder.read_slip(Path(path))


def read_legs(path: PathLike, *, columns: PathLike | None = None) -> LegLog:
    """Read leg angles over time from a table, a recorded run or a walk folder.

    Args:
        path: What to read.
        columns: A `columns.toml` in place of the one beside the table.

    Raises:
        ZebroLabError: A file is missing or cannot be used; names file, row and column.
    """
    return read_leg_log(Path(path), columns=_path(columns))


def read_track(path: PathLike) -> TrackFile:
    """Read tracked poses and their covariance.

    Args:
        path: A table of poses, or the folder of a `track.csv`.

    Raises:
        ZebroLabError: A file is missing or cannot be used; names file, row and column.
    """
    return read_track_file(Path(path))


def walk_gait(
    gait: str = "tripod",
    *,
    slip: str | None = "thesis",
    duration: float = 10.0,
    model: str = "dynamics",
    steering: float | None = None,
    direction: Direction | None = None,
    robot: PathLike | None = None,
    draws: int = 0,
    seed: int = 1,
    out: PathLike | None = None,
) -> WalkResult:
    """Compute the path of a gait, as `zebro-lab walk` does.

    Args:
        gait: Name of the gait.
        slip: A calibration folder or `slip.toml`, "coulomb:MU[:V]" or "thesis"; None for a model
            without slip.
        duration: Time to walk [s].
        model: "dynamics", "thesis", "no-slip" or "no-slip-simple".
        steering: Ratio of the outer to the inner legs' stance angle; 1 walks straight [-].
        direction: Side to turn to.
        robot: A `robot.toml`; the thesis's robot when None.
        draws: Paths to draw for a band, at least two; 0 for the single path.
        seed: Seed of all random numbers.
        out: Walk folder to write; None to keep nothing.

    Raises:
        ZebroLabError: A file or an option cannot be used.
        ModelError: The walk cannot be computed.
    """
    with _folder(out) as folder:
        request = WalkRequest(
            GaitRequest(gait, steering=steering, direction=direction),
            ModelRequest(folder, slip=slip, model=model, robot=_path(robot)),
            duration,
            band=BandRequest(draws, seed=seed) if draws else None,
        )
        return _walk_result(walk(request, Silent()), folder, draws)


def predict_walk(
    legs: PathLike,
    *,
    slip: str | None,
    model: str = "dynamics",
    robot: PathLike | None = None,
    columns: PathLike | None = None,
    draws: int = 0,
    seed: int = 1,
    out: PathLike | None = None,
) -> WalkResult:
    """Predict the path from measured leg angles, as `zebro-lab predict` does.

    Args:
        legs: A table of leg angles, a recorded run, or a walk folder.
        slip: As in `walk_gait`.
        model: As in `walk_gait`.
        robot: A `robot.toml`; the run's own, else the thesis's robot, when None.
        columns: A `columns.toml` in place of the one beside the table.
        draws: Paths to draw for a band, at least two; 0 for the single path.
        seed: Seed of all random numbers.
        out: Walk folder to write; None to keep nothing.

    Raises:
        ZebroLabError: A file or an option cannot be used.
        ModelError: The walk cannot be computed.
    """
    with _folder(out) as folder:
        request = PredictRequest(
            Path(legs),
            ModelRequest(folder, slip=slip, model=model, robot=_path(robot)),
            columns=_path(columns),
            band=BandRequest(draws, seed=seed) if draws else None,
        )
        return _walk_result(predict(request, Silent()), folder, draws)


def track_photos(
    photos: PathLike,
    *,
    out: PathLike,
    camera: PathLike,
    floor: PathLike,
    robot: PathLike | None = None,
    times: PathLike | None = None,
    start: datetime | None = None,
    annotations: PathLike | None = None,
    without_marker: bool = False,
    merged: "Merged | None" = None,
) -> TrackResult:
    """Track the robot in photographs, as `zebro-lab track` does.

    Args:
        photos: Folder of photographs, video, or one composite picture.
        out: Track folder to write.
        camera: The `camera.toml`.
        floor: The `floor.toml`.
        robot: The `robot.toml`; the thesis's robot when None.
        times: CSV with columns `photo` and `t_s`; None to take the photographs' own times.
        start: Moment from which time is counted, with its time zone; None for the first
            photograph.
        annotations: File of annotations that a person made in the photographs.
        without_marker: Whether to track the robot by a template, annotated in one photograph.
        merged: How the exposures of a composite picture were merged: "pasted", "darkest" or
            "mean".

    Raises:
        ZebroLabError: A file or an option cannot be used.
        TrackingError: The photographs do not give a track.
    """
    request = TrackRequest(
        Path(photos), Path(camera), Path(floor), robot=_path(robot), out=Path(out),
        times=TimeRequest(table=_path(times)), start=start, annotations=_path(annotations),
        without_marker=without_marker, merged=merged,
    )  # fmt: skip
    return track(request, Silent())


def validate_walks(
    *walks: PathLike | tuple[PathLike, PathLike],
    out: PathLike | None = None,
    anchor: bool = True,
    time_offset: float | None = 0.0,
    seed: int = 1,
) -> Validated:
    """Compute errors of predictions against tracks, as `zebro-lab validate` does.

    Args:
        walks: Run folders with a prediction and a track, or pairs of the two.
        out: Validation folder to write; None to keep nothing.
        anchor: Whether each path starts from the first tracked pose, which is then not scored.
        time_offset: Clock offset added to the tracks' times; None to estimate it [s].
        seed: Seed of all random numbers.

    Raises:
        ZebroLabError: A file is missing, or prediction and track share no time.
        ModelError: A path cannot be judged.
    """
    pairs = tuple(
        (Path(each[0]), Path(each[1])) if isinstance(each, tuple) else pairs_of_run(Path(each))
        for each in walks
    )
    with _folder(out) as folder:
        request = ValidateRequest(pairs, folder, anchor, time_offset, seed)
        return validate(request, Silent())


def write_report(
    data: PathLike, *, out: PathLike, calibration: PathLike | None = None, title: str | None = None
) -> Path:
    """Write an HTML report of one or several runs from their result folders.

    Args:
        data: A run folder, or a folder of them.
        out: File to write.
        calibration: The calibration folder; `calibration` beside the data when None.
        title: Title of the page; the folder's name when None.

    Returns:
        The file.

    Raises:
        ZebroLabError: There is nothing to report on, or a manifest is damaged.
    """
    folder = Path(data).absolute().parent / "calibration" if calibration is None else calibration
    report(ReportRequest(Path(data), Path(folder), Path(out), title), made=datetime.now(UTC))
    return Path(out)


def open_run(folder: PathLike) -> Run:
    """Open a recorded or imported run.

    Args:
        folder: The run folder.

    Raises:
        ZebroLabError: It is no run, or its manifest is damaged.
    """
    return Run(Path(folder), read_manifest(Path(folder)))


@contextmanager
def open_devices(
    *, zebro: str | None = None, imus: Sequence[str] = (), rig: str | None = None, seed: int = 0
) -> Iterator[OpenDevices]:
    """Open devices, real or simulated; leaving the context de-energises what they drive.

    Args:
        zebro: The robot: "PROFILE@PORT", "PROFILE@sim" or "sim".
        imus: Inertial measurement units, each in the same way.
        rig: The slip rig, in the same way.
        seed: Seed of the random numbers of simulated devices.

    Yields:
        The devices, their drivers connected.

    Raises:
        SettingsError: No device is named.
        RigError: An address, a profile or a port is not right.
    """
    request = DevicesRequest(zebro=zebro, imus=tuple(imus), rig=rig, seed=seed)
    with open_devices_of(request) as devices:
        yield devices


def _path(path: PathLike | None) -> Path | None:
    return None if path is None else Path(path)


@contextmanager
def _folder(out: PathLike | None) -> Iterator[Path]:
    """Yield the folder to write, or one that is removed afterwards."""
    if out is not None:
        yield Path(out)
        return
    with TemporaryDirectory() as temporary:
        yield Path(temporary) / "result"


def _walk_result(walked: Walked, folder: Path, draws: int) -> WalkResult:
    return WalkResult(walked.path, read_draws(folder) if draws else None, walked.notes)
