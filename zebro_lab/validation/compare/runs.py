# SPDX-License-Identifier: MIT
"""Compare the tracks of two runs: speed, yaw rate and curvature."""

from pathlib import Path

import numpy as np

from model.arrays import Array
from model.metrics.turning import mean_yaw_rate
from model.poses import Poses
from model.travel import path_length
from zebro_lab.files.errors import DataError
from zebro_lab.files.names import TRACK
from zebro_lab.track.file import TrackFile, read_track
from zebro_lab.validation.compare.values import Comparison, Quantity

TRACKS = 1000  # paths drawn with a track's covariance
_SUMMARY = (("speed", "mm/s", 1e3), ("yaw rate", "deg/s", 180 / np.pi), ("curvature", "1/m", 1.0))


def compare_runs(
    first: Path, second: Path, *, names: tuple[str, str], rng: np.random.Generator
) -> Comparison:
    """Compare speed, yaw rate and curvature of the tracks of two runs.

    Args:
        first: A run folder with `track/`.
        second: Another run folder.
        names: Names to show for the first and the second.
        rng: Random number generator.

    Raises:
        ZebroLabError: A track cannot be read, or has no headings.
    """
    tracks = [_read(first), _read(second)]
    drawn = [_summaries(track, rng) for track in tracks]
    return Comparison(
        kind="runs",
        names=names,
        quantities=tuple(
            Quantity(f"{name}, tracked", unit, (scale * drawn[0][:, i], scale * drawn[1][:, i]))
            for i, (name, unit, scale) in enumerate(_SUMMARY)
        ),
        source=", ".join(sorted({track.source for track in tracks})),
        files=tuple(track.file for track in tracks),
        notes=tuple(
            f"{n}: {x}" for n, track in zip(names, tracks, strict=True) for x in track.notes
        ),
        paths=tuple(_from_origin(track.poses) for track in tracks),
    )


def _read(run: Path) -> TrackFile:
    """Read the track of a run folder; raise `DataError` if it has no headings."""
    track = read_track(run / TRACK)
    if not track.poses.has_yaw:
        raise DataError("has no headings: track it again with a marker or both prints", file=run)
    return track


def _summaries(track: TrackFile, rng: np.random.Generator) -> Array:
    """Compute mean speed [m/s], yaw rate [rad/s] and curvature [1/m] of drawn tracks, shape (n, 3).

    Speed is length, without noise (`model.travel`), over time; curvature is yaw rate over speed, 0
    for a path of length 0.
    """
    rows = []
    for errors in track.joint.draw(TRACKS, rng=rng):
        poses = Poses.of_states(track.poses.t, track.poses.states + errors)
        speed, rate = path_length(poses) / float(np.ptp(poses.t)), mean_yaw_rate(poses)
        rows.append((speed, rate, rate / speed if speed > 0 else 0.0))
    return np.array(rows)


def _from_origin(poses: Poses) -> Poses:
    """Move poses so that the first lies at the origin and heads along x."""
    turned = poses.moved(rotation=-float(poses.yaw[0]), translation=[0.0, 0.0])
    return turned.moved(rotation=0.0, translation=-turned.position[0])
