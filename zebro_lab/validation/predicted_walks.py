# SPDX-License-Identifier: MIT
"""Choose the walks to validate, and read their predictions, tracks, IMU data and photographs."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.files.names import PATH_CSV, TRACK, numbered
from zebro_lab.files.replacement import recover
from zebro_lab.runs.counted_once import content_hash, duplicates_note, first_of_each
from zebro_lab.runs.manifest import RIG_KIND, read_manifest
from zebro_lab.runs.recorded_walk import TRACK_ALONE, Tilt, is_recorded, read_recorded_tilt
from zebro_lab.track.file import TrackFile, read_track
from zebro_lab.track.folder import TRACK_CSV
from zebro_lab.track.photographs import TrackedPhotos, photos_of_track
from zebro_lab.validation.judged_run import JudgedRun
from zebro_lab.walk.folder import PREDICTION
from zebro_lab.walk.prediction_file import PredictionFile, read_prediction

Pair = tuple[Path, Path]


def pairs_of_runs(paths: Sequence[Path]) -> tuple[list[Pair], tuple[str, ...]]:
    """Return the folders of prediction and track of each run, and what is left out of several.

    A single path must be a run with both. If there are several, those that are no such run are left
    out, each with a note. Without any path both are empty.

    Args:
        paths: Paths, in order.

    Raises:
        NotFound: A path does not exist, the only path lacks prediction or track, or all do.
        DataError: The manifest of a run is invalid, or a run was imported without leg angles and
            has no prediction.
    """
    if len(paths) == 1:
        return [pairs_of_run(paths[0])], ()
    pairs, left_out = [], []
    for path in paths:
        if (reason := _why_none(path)) is None:
            try:
                pairs.append(pairs_of_run(path))
                continue
            except NotFound as error:
                reason = str(error)
        left_out.append(f"left out, {path.name}: {reason}")
    if paths and not pairs:
        raise NotFound(
            f"none of {len(paths)} paths is a run with prediction and track; {'; '.join(left_out)}"
        )
    return pairs, tuple(left_out)


def _why_none(path: Path) -> str | None:
    """Return why a path is certainly no tracked walk; None if it may be one.

    It may be one if it is a recorded run other than one of the slip rig, or has one of the folders
    `prediction` and `track`. Raise `NotFound` if it does not exist.
    """
    if not path.exists():
        raise NotFound(f"{path}: no such file or folder; name run folders")
    if not path.is_dir():
        return "a file, no run folder"
    if is_recorded(path):
        return "a run of the slip rig" if read_manifest(path).kind == RIG_KIND else None
    known = any((path / name).is_dir() for name in (PREDICTION, TRACK))
    return None if known else "no run folder"


@dataclass(frozen=True)
class PredictedWalk:
    """A walk with its prediction and its track, as read from files.

    Attributes:
        name: Name of the walk's folder, with a number if other walks have the same.
        prediction: The prediction with draws and baselines.
        track: The track, in its own time base.
        tilt: Roll and pitch measured by the run's IMU; None without an IMU or run folder.
        photos: Photographs of the track; None if they cannot be shown.
        duplicates: Notes on what was left out, such as walks that were given twice, on the first
            walk only; else empty.
        not_shown: Note on why photographs cannot be shown; empty if they can.
    """

    name: str
    prediction: PredictionFile
    track: TrackFile
    tilt: Tilt | None
    photos: TrackedPhotos | None
    duplicates: tuple[str, ...]
    not_shown: tuple[str, ...]

    @property
    def sources(self) -> tuple[str, ...]:
        """Sources of what was measured: of the prediction's data, of the track and of the IMU."""
        tilt = () if self.tilt is None else (self.tilt.source,)
        return (*self.prediction.sources, self.track.source, *tilt)

    def files_of(self, judged: JudgedRun) -> tuple[Path, ...]:
        """Return the files of prediction and track, and of the IMU if `judged` has tilt errors.

        Manifests and photographs are not among them.
        """
        tilt = () if self.tilt is None or judged.tilt is None else self.tilt.files
        return (*self.prediction.files, self.track.file, *tilt)


@dataclass(frozen=True)
class ShownRun:
    """Errors of a walk, with the content of the pictures that show them.

    Attributes:
        run: Errors of the walk.
        prediction: The prediction, with band and single path.
        photos: Photographs of the track; None if there are none to show.
        time_offset: Time added to the track's times to bring them to the prediction's clock [s].
    """

    run: JudgedRun
    prediction: PredictionFile
    photos: TrackedPhotos | None = None
    time_offset: float = 0.0


def pairs_of_run(run: Path) -> tuple[Path, Path]:
    """Return the folders `prediction` and `track` of a run folder.

    Raises:
        NotFound: `prediction/path.csv` or `track/track.csv` is missing.
        DataError: The run was imported without leg angles, and has no prediction.
    """
    prediction, track = recover(run / PREDICTION), recover(run / TRACK)
    if not (prediction / PATH_CSV).is_file():
        if is_recorded(run) and read_manifest(run).is_track_alone:
            raise DataError(
                f"{run}: {TRACK_ALONE}, or compare two tracks with: zebro-lab validate "
                f"REFERENCE {track / TRACK_CSV}"
            )
        raise NotFound(
            f"{prediction}: no prediction; make one with: zebro-lab predict {run} --slip "
            f"CALIBRATION --out {prediction}"
        )
    if not (track / TRACK_CSV).is_file():
        raise NotFound(
            f"{track}: no {TRACK_CSV}; make one with: zebro-lab track PHOTOS --run {run} "
            "--camera camera.toml --floor floor.toml --robot robot.toml"
        )
    return prediction, track


def read_predicted_walks(
    pairs: Sequence[tuple[Path, Path]], *, notes: tuple[str, ...] = ()
) -> list[PredictedWalk]:
    """Read predictions and tracks of walks; only the first of pairs with equal content.

    Args:
        pairs: Paths of prediction and track of each walk.
        notes: Notes on what was left out before, for the first walk.

    Raises:
        ZebroLabError: A file is missing or damaged, or a pair is exchanged; a missing or changed
            photograph is only a note.
    """
    for pair in pairs:
        _require_not_exchanged(*pair)
    pairs, repeated = first_of_each(pairs, key=_content)
    duplicates = duplicates_note("walks", [(one[0], other[0]) for one, other in repeated])
    names = numbered([_name(predicted) for predicted, _ in pairs])
    return [
        _read(name, *pair, () if i else (*notes, *duplicates))
        for i, (name, pair) in enumerate(zip(names, pairs, strict=True))
    ]


def _read(name: str, predicted: Path, tracked: Path, duplicates: tuple[str, ...]) -> PredictedWalk:
    """Read a walk; its IMU data only if `tracked` is the folder `track` of a run.

    Photographs that are missing, changed or not stated are only noted, in `not_shown`.
    """
    run = tracked.parent if tracked.name == TRACK and is_recorded(tracked.parent) else None
    tilt = None if run is None else read_recorded_tilt(run)
    prediction, track = read_prediction(predicted), read_track(tracked)
    photos, not_shown = None, ()
    try:
        photos = photos_of_track(tracked)
    except (NotFound, DataError, SettingsError) as error:
        not_shown = (f"photographs are not shown: {error}",)
    return PredictedWalk(name, prediction, track, tilt, photos, duplicates, not_shown)


def _require_not_exchanged(predicted: Path, tracked: Path) -> None:
    """Raise `SettingsError` if a prediction and a track are given for each other."""
    if _is(predicted, TRACK_CSV, not_=PATH_CSV) and _is(tracked, PATH_CSV, not_=TRACK_CSV):
        raise SettingsError(
            f"{predicted} is a track and {tracked} a prediction; expected them the other way "
            "round: exchange the two",
            key="--predicted, --track",
        )


def _is(path: Path, name: str, *, not_: str) -> bool:
    """Return whether a path is a file `name`, or a folder with such a file and without `not_`."""
    if path.is_dir():
        return (path / name).is_file() and not (path / not_).is_file()
    return path.name == name


def _content(pair: tuple[Path, Path]) -> tuple[str, ...]:
    """Return hashes of `path.csv` and `track.csv` of a walk; for a missing file its path."""
    return tuple(
        content_hash(file) if file.is_file() else str(file)
        for path, name in zip(pair, (PATH_CSV, TRACK_CSV), strict=True)
        for file in [recover(path) / name if path.is_dir() else path]
    )


def _name(predicted: Path) -> str:
    """Return the name of the run whose `prediction` this is, else of the folder or table."""
    place = (predicted if predicted.is_dir() else predicted.with_suffix("")).absolute()
    return place.parent.name if place.name == PREDICTION else place.name
