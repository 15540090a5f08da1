# SPDX-License-Identifier: MIT
"""Read a predicted path from a walk folder with its draws, or from a table of poses."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from model.gait.reference import SampledReference
from model.judgement import STAND_STILL, Prediction
from model.poses import Poses
from model.robot import Robot
from model.walk.path import WalkPath
from model.walk_models import baseline_paths
from zebro_lab.files.errors import DataError
from zebro_lab.files.folder_manifest import changed_output
from zebro_lab.files.names import PATH_CSV
from zebro_lab.files.replacement import recover
from zebro_lab.track.file import read_poses
from zebro_lab.walk.folder import (
    DRAWS,
    MANIFEST,
    doubts,
    measured_sources,
    read_draws,
    read_walk,
    read_walk_manifest,
)

NOT_SAID = "not said"  # by the manifest of an earlier version


@dataclass(frozen=True)
class WalkedPath:
    """The single path of a walk folder with all its columns, and the robot that walked it."""

    path: WalkPath
    robot: Robot


@dataclass(frozen=True)
class PredictionFile:
    """A prediction as read from files.

    Attributes:
        prediction: The predicted path with its draws and baselines.
        sources: Where the data come from that the path was computed from, see
            `measured_sources`; "unknown" for a table of poses.
        files: The table; or `path.csv` and, if there are draws, `draws.npz`, without the manifest.
        notes: Notes, one line each.
        walk: The single path with roll, pitch, legs and robot; None for a table of poses.
    """

    prediction: Prediction
    sources: tuple[str, ...]
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    walk: WalkedPath | None = None


def read_prediction(path: Path) -> PredictionFile:
    """Read a walk folder (or its path.csv), draws if any, and compute baselines; or a pose table.

    The only baseline of a table is the one that stands still.

    Raises:
        ZebroLabError: A file is missing or damaged, or is not a path.
    """
    recover(path)
    file = path / PATH_CSV if path.is_dir() else path
    poses = read_poses(file)
    folder = file.parent
    if file.name != PATH_CSV or not (folder / MANIFEST).is_file():
        note = f"{path.name}: not a walk folder, so '{STAND_STILL}' is the only baseline"
        return PredictionFile(Prediction(poses), ("unknown",), (file,), (note,))
    manifest = read_walk_manifest(folder)
    has_draws = (folder / DRAWS).is_file()
    draws = read_draws(folder) if has_draws else None
    walk = WalkedPath(read_walk(folder), robot_of_walk(manifest, folder))
    baselines, notes = _baselines(walk, manifest)
    changed = (f"WARNING: {each}" for each in changed_output(file))
    return PredictionFile(
        Prediction(poses, draws, baselines),
        measured_sources(manifest),
        (file, *([folder / DRAWS] if has_draws else [])),
        (
            *changed,
            *doubts(manifest),
            *notes,
            *(_anisotropy(manifest) if has_draws else ()),
            *(() if has_draws else ("no draws, so no band: run predict with --draws 500",)),
        ),
        walk,
    )


def _anisotropy(manifest: Mapping[str, Any]) -> tuple[str, ...]:
    """Return a note on how traction across the legs may differ from that along them in a band.

    The manifest's factor is 1 for traction alike in both directions, which also holds for earlier
    versions that do not say; None for the lateral traction of fitted walks; else one standard
    deviation of the ratio of both, as a factor.
    """
    settings = manifest["settings"]
    factor = (settings.get("band") or {}).get("anisotropy", NOT_SAID)
    if factor in (NOT_SAID, 1):
        return ("the band takes grip and slip stiffness to be alike along and across the legs",)
    if factor is None:
        return ("the band has lateral grip and slip stiffness as walks inform them",)
    return (
        "the band has grip and slip stiffness across the legs, over those along them, as "
        f"1 ×/÷ {factor:g} each",
    )


def robot_of_walk(manifest: Mapping[str, Any], folder: Path) -> Robot:
    """Construct the robot of a walk's manifest, with leg offsets 0: a walk's angles are exact.

    Args:
        manifest: Content of the walk's manifest.
        folder: Folder of the walk, for the message.

    Raises:
        DataError: The manifest has no robot or not all of its parameters.
    """
    try:
        described = manifest["settings"]["robot"]
        return Robot(
            hips=np.array(described["hips"]),
            leg_radius=described["leg_radius"],
            leg_arc=described["leg_arc"],
            mass=described["mass"],
            body_size=tuple(described["body_size"]),
            inertia=tuple(described["inertia"]),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise DataError(
            f"settings.robot is missing or invalid ({error}); run walk or predict again",
            file=folder / MANIFEST,
        ) from error


def _baselines(
    walked: WalkedPath, manifest: Mapping[str, Any]
) -> tuple[dict[str, Poses], tuple[str, ...]]:
    """Compute the baseline paths of a walk, by name; also return notes.

    Fitted leg offsets in the manifest are subtracted: baselines have the robot's described legs.
    """
    walk = walked.path
    found = (manifest["settings"].get("walks") or {}).get("leg_offset", 0.0)
    reference = SampledReference(walk.t - walk.t[0], walk.theta - np.asarray(found))
    direction = manifest["settings"].get("direction", "left")
    start = float(walk.t[0])
    return baseline_paths(walked.robot, reference, direction=direction, start=start)
