# SPDX-License-Identifier: MIT
"""A prediction against a track: errors of the path, honesty of the band, and the baselines."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from model.errors import DomainError, InsufficientData, WalkError
from model.gait.reference import SampledReference
from model.metrics.consistency import FEWEST_DRAWS, Consistency, consistency
from model.metrics.path_errors import PathErrors, path_errors
from model.metrics.poses import Poses, overlap
from model.metrics.scores import EnsembleScores, ensemble_scores, with_tracker_noise
from model.metrics.tilt import TiltErrors, tilt_errors
from model.predict import anchored, states_at
from model.robot import Robot
from model.slip.law import Array
from model.walk.ensemble import PathEnsemble
from model.walk.path import WalkPath
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.names import PATH_CSV
from zebro_lab.files.replacement import settle
from zebro_lab.runs.recorded_tilt import Tilt
from zebro_lab.track.file import TrackFile, read_poses
from zebro_lab.walk.folder import DRAWS, MANIFEST, PREDICTION, read_walk, read_walk_manifest
from zebro_lab.walk.models import MODELS, Direction, ModelRun
from zebro_lab.walk.path_band import read_draws

STAND_STILL = "stand still"
BASELINES = ("no-slip-simple", "no-slip", "thesis")


@dataclass(frozen=True)
class WalkedPath:
    """The single path of a walk folder with all that the model says of it, and its robot."""

    path: WalkPath
    robot: Robot


@dataclass(frozen=True)
class Prediction:
    """A predicted path as it was read.

    Attributes:
        path: The single path: every unknown at its middle. The mean of an ensemble is no path; it
            is shorter and less curved than any draw.
        draws: The ensemble; None for a path alone.
        baselines: What simpler models make of the same leg angles, by name.
        source: Where it comes from.
        files: Files that were read.
        notes: For a person, one line each.
        walk: The single path with roll, pitch, legs and robot; None where it is a bare table.
    """

    path: Poses
    draws: PathEnsemble | None
    baselines: Mapping[str, Poses]
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    walk: WalkedPath | None = None


@dataclass(frozen=True)
class Judged:
    """One path, or ensemble, judged against a track.

    Attributes:
        name: "prediction", or a baseline's name.
        path: The path, started from the first tracked pose.
        errors: Its errors.
        scores: Its scores; those of a single path are absolute errors.
        consistency: The track against the ensemble's own draws; empty for a single path.
    """

    name: str
    path: Poses
    errors: PathErrors
    scores: EnsembleScores
    consistency: tuple[Consistency, ...] = ()


@dataclass(frozen=True)
class TiltJudged:
    """Roll and pitch against an IMU's.

    Attributes:
        errors: How far they are apart.
        t: Times compared, shape (n,) [s].
        predicted: Roll and pitch of the prediction, shape (n, 2) [rad].
        measured: The IMU's, shape (n, 2) [rad].
    """

    errors: TiltErrors
    t: Array
    predicted: Array
    measured: Array


@dataclass(frozen=True)
class RunJudged:
    """A walk's prediction and baselines, judged.

    Attributes:
        name: Name of the walk.
        track: The track that was scored, its first pose left out when it started the prediction.
        rows: The prediction first, then the baselines.
        band: The ensemble as it was judged; None for a path alone.
        notes: For a person, one line each.
        tilt: Roll and pitch against the IMU's; None where the run has none.
    """

    name: str
    track: Poses
    rows: tuple[Judged, ...]
    band: PathEnsemble | None
    notes: tuple[str, ...]
    tilt: TiltJudged | None = None


def read_prediction(path: Path) -> Prediction:
    """Read a walk folder with its draws, or any table of poses.

    Raises:
        ZebroLabError: It is missing, or no path.
    """
    settle(path)
    file = path / PATH_CSV if path.is_dir() else path
    poses = read_poses(file)
    folder = file.parent
    if file.name != PATH_CSV or not (folder / MANIFEST).is_file():
        note = f"{path.name}: no walk folder, so no baseline but '{STAND_STILL}'"
        return Prediction(poses, None, {}, "unknown", (file,), (note,))
    manifest = read_walk_manifest(folder)
    has_draws = (folder / DRAWS).is_file()
    draws = read_draws(folder) if has_draws else None
    walk = WalkedPath(read_walk(folder), robot_of_walk(manifest))
    baselines, notes = _baselines(walk, manifest)
    return Prediction(
        poses,
        draws,
        baselines,
        str(manifest.get("source", "unknown")),
        (file, *([folder / DRAWS] if has_draws else [])),
        (*notes, *(() if has_draws else ("no draws: predict with --draws 500 for a band",))),
        walk,
    )


def judge_run(
    name: str,
    prediction: Prediction,
    track: TrackFile,
    *,
    anchor: bool,
    rng: np.random.Generator,
) -> RunJudged:
    """Judge a prediction and the baselines against a track.

    Args:
        name: Name of the walk.
        prediction: What was predicted.
        track: What was tracked, by the prediction's clock.
        anchor: Start every path from the first tracked pose, which is then not scored.
        rng: Source of randomness.

    Raises:
        DataError: Track and prediction share too little time.
    """
    inside = shared_time(track.poses, prediction.path, file=track.file)
    seen, covariance = track.poses.part(inside), track.covariance[inside]
    scored = slice(1, None) if anchor else slice(None)
    if len(seen.part(scored)) < 2:
        raise DataError("leaves fewer than two poses to score", file=track.file)
    first = np.append(seen.position[0], seen.yaw[0])
    if anchor and not np.isfinite(first[2]):
        raise SettingsError(
            "the track has no headings, so its first pose cannot start a prediction; use "
            "--no-anchor and look at the aligned errors",
            key="--anchor",
        )
    target, noise = seen.part(scored), covariance[scored]

    def placed(path: Poses) -> PathEnsemble:
        single = PathEnsemble(path.t, path.position[None], path.yaw[None])
        return anchored(single, first, at=float(seen.t[0]), rng=rng) if anchor else single

    candidates = {PREDICTION: prediction.path, **prediction.baselines}
    rows = [_judge_path(key, placed(path), target) for key, path in candidates.items()]
    rows.append(_judge_path(STAND_STILL, _still(seen), target))
    band = prediction.draws
    if band is not None:
        if anchor:
            band = anchored(band, first, at=float(seen.t[0]), covariance=covariance[0], rng=rng)
        rows[0] = _judge_band(rows[0], band, target, noise, rng)
    left_out = len(track.poses) - len(seen)
    notes = (*track.notes, *prediction.notes)
    if left_out:
        notes += (f"{left_out} tracked poses lie outside the predicted time and are not scored",)
    return RunJudged(name, target, tuple(rows), band, notes)


def _judge_path(name: str, path: PathEnsemble, target: Poses) -> Judged:
    single = Poses(path.t, path.position[0], path.yaw[0])
    scores = ensemble_scores(states_at(path, target.t), _states(target))
    return Judged(name, single, path_errors(single, target), scores)


def _judge_band(
    single: Judged, band: PathEnsemble, target: Poses, noise: Array, rng: np.random.Generator
) -> Judged:
    draws = states_at(band, target.t)
    seen = with_tracker_noise(draws, noise, rng=rng)
    enough = len(draws) >= FEWEST_DRAWS
    return replace(
        single,
        scores=ensemble_scores(seen, _states(target)),
        consistency=consistency(draws, _states(target), noise, rng=rng) if enough else (),
    )


def _states(poses: Poses) -> Array:
    return np.column_stack([poses.position, poses.yaw])


def _still(seen: Poses) -> PathEnsemble:
    n = len(seen)
    position = np.broadcast_to(seen.position[0], (1, n, 2))
    return PathEnsemble(seen.t, position, np.full((1, n), seen.yaw[0]))


def shared_time(track: Poses, path: Poses, *, file: Path) -> NDArray[np.bool_]:
    """Tell which tracked poses lie within the time of a path, shape (len(track),).

    Args:
        track: The track.
        path: The path.
        file: The track's file, for the message.

    Raises:
        DataError: Fewer than two do.
    """
    try:
        return overlap(track, path)
    except InsufficientData as error:
        raise DataError(
            f"{error} Give --time-offset SECONDS, which is added to the track's times, or "
            "--estimate-offset",
            file=file,
        ) from error


def judge_tilt(walk: WalkedPath, measured: Tilt) -> TiltJudged:
    """Compare roll and pitch of a walk with an IMU's; both keep the run's clock.

    Raises:
        InsufficientData: They share too little time.
    """
    path = walk.path
    errors, inside = tilt_errors(path.t, path.orientation[:, :2], measured.t, measured.angles)
    t = measured.t[inside]
    predicted = np.column_stack([np.interp(t, path.t, a) for a in path.orientation[:, :2].T])
    return TiltJudged(errors, t, predicted, measured.angles[inside])


def robot_of_walk(manifest: Mapping[str, Any]) -> Robot:
    """Read the robot without leg offsets: the angles of a walked path are true ones already."""
    described = manifest["settings"]["robot"]
    return Robot(
        hips=np.array(described["hips"]),
        leg_radius=described["leg_radius"],
        leg_arc=described["leg_arc"],
        mass=described["mass"],
        body_size=tuple(described["body_size"]),
        inertia=tuple(described["inertia"]),
    )


def _baselines(
    walked: WalkedPath, manifest: Mapping[str, Any]
) -> tuple[dict[str, Poses], tuple[str, ...]]:
    """Walk the leg angles of a walk folder by every simpler model: as described, not as fitted."""
    walk, robot = walked.path, walked.robot
    found = (manifest["settings"].get("walks") or {}).get("leg_offset", 0.0)
    reference = SampledReference(walk.t - walk.t[0], walk.theta - np.asarray(found))
    direction = manifest["settings"].get("direction", "left")
    return walk_baselines(robot, reference, direction=direction, start=float(walk.t[0]))


def walk_baselines(
    robot: Robot, reference: SampledReference, *, direction: Direction = "left", start: float = 0.0
) -> tuple[dict[str, Poses], tuple[str, ...]]:
    """Walk leg angles by every simpler model.

    Args:
        robot: The robot.
        reference: True leg angles from time zero on; all of them are walked.
        direction: Side the gait turns to; only the source's model asks.
        start: Added to the paths' times [s].

    Returns:
        Paths by the models' names, and what to tell a person of those that cannot walk.
    """
    duration = float(reference.t[-1])
    paths, notes = {}, []
    for name in BASELINES:
        model = MODELS[name]
        slip = parse_slip("thesis") if model.slips else None
        run = ModelRun(robot, reference, slip, duration, model.dt, "saturated", direction)
        try:
            path = model.run(run)
        except (WalkError, DomainError) as error:
            notes.append(f"baseline '{name}' cannot walk these leg angles: {error}")
            continue
        paths[name] = Poses(path.t + start, path.position[:, :2], path.yaw)
    return paths, tuple(notes)
