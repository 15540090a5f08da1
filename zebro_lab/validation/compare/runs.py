# SPDX-License-Identifier: MIT
"""Compare two runs: speed, yaw rate and curvature, tracked and predicted."""

from pathlib import Path

import numpy as np

from model.arrays import Array
from model.metrics.turning import mean_yaw_rate
from model.path_draws import states_at
from model.poses import Poses
from model.travel import path_length
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.names import TRACK
from zebro_lab.files.replacement import settle
from zebro_lab.track.file import TrackFile, read_track
from zebro_lab.track.folder import TRACK_CSV
from zebro_lab.validation.compare.values import Comparison, Quantity, RunPaths
from zebro_lab.walk.folder import DRAWS, PREDICTION, doubts, measured_sources, read_walk_manifest
from zebro_lab.walk.path_band import read_draws

TRACKS = 1000  # paths drawn with a track's covariance
EVERY = 1.0  # s between poses of a predicted path without a track
_SUMMARY = (("speed", "mm/s", 1e3), ("yaw rate", "deg/s", 180 / np.pi), ("curvature", "1/m", 1.0))


def is_walked(folder: Path) -> bool:
    """Return whether a folder has `track/track.csv` or `prediction/draws.npz`."""
    track, prediction = settle(folder / TRACK), settle(folder / PREDICTION)
    return (track / TRACK_CSV).is_file() or (prediction / DRAWS).is_file()


def compare_runs(
    first: Path, second: Path, *, names: tuple[str, str], rng: np.random.Generator
) -> Comparison:
    """Compare speed, yaw rate and curvature of two runs, by tracks, predictions, or both.

    Args:
        first: A run folder with `track/`, or with `prediction/` that has draws.
        second: Another run folder.
        names: Names to show for the first and the second.
        rng: Random number generator.

    Raises:
        ZebroLabError: A run has neither track nor draws, a file cannot be read, or the runs have
            neither tracks with headings nor draws in common.
    """
    runs = (_Run(first), _Run(second))
    quantities = [
        *_quantities("tracked", [run.tracks(rng) for run in runs]),
        *_quantities("predicted", [run.predicted() for run in runs]),
    ]
    if not quantities:
        raise DataError(
            f"has {_what(runs[1])}, the first has {_what(runs[0])}: nothing is common to both; "
            "track both (with headings), or predict both with --draws 500",
            file=second,
        )
    return Comparison(
        kind="runs",
        names=names,
        quantities=tuple(quantities),
        source=", ".join(sorted({each for run in runs for each in run.sources})),
        files=tuple(dict.fromkeys(file for run in runs for file in run.files)),
        notes=tuple(f"{n}: {note}" for n, r in zip(names, runs, strict=True) for note in r.notes),
        paths=tuple(run.paths for run in runs),
    )


class _Run:
    """Track and prediction draws of a run; None for the one that the run does not have."""

    def __init__(self, folder: Path) -> None:
        settle(folder / TRACK)
        settle(folder / PREDICTION)
        self.track: TrackFile | None = None
        self.band: Poses | None = None
        self.files: list[Path] = []
        self.sources: list[str] = []
        self.notes: list[str] = []
        if (folder / TRACK / TRACK_CSV).is_file():
            self.track = read_track(folder / TRACK)
            self.files.append(self.track.file)
            self.sources.append(self.track.source)
            self.notes += self.track.notes
        if (folder / PREDICTION / DRAWS).is_file():
            self.band = read_draws(folder / PREDICTION)
            self.files.append(folder / PREDICTION / DRAWS)
            manifest = read_walk_manifest(folder / PREDICTION)
            self.sources += measured_sources(manifest)
            self.notes += doubts(manifest)
        if not self.files:
            raise NotFound(f"{folder} holds neither {TRACK}/{TRACK_CSV} nor {PREDICTION}/{DRAWS}")

    def tracks(self, rng: np.random.Generator) -> Array | None:
        """Draw `TRACKS` tracks with the track's covariance, and compute speed, yaw rate, curvature.

        Returns an array of shape (TRACKS, 3), see `_summaries`; None without track or headings.
        """
        if self.track is None or not self.track.poses.has_yaw:
            return None
        poses = self.track.poses
        noise = self.track.joint.draw(TRACKS, rng=rng)
        return _summaries(poses.t, poses.states + noise)

    def predicted(self) -> Array | None:
        """Compute speed, yaw rate and curvature of each drawn path, shape (n, 3), see `_summaries`.

        Poses are interpolated at the track's times within the prediction; every second if these are
        fewer than two or there is no track. None without draws.
        """
        if self.band is None:
            return None
        t = np.arange(self.band.t[0], self.band.t[-1], EVERY)
        if self.track is not None:
            seen = self.track.poses.t
            inside = seen[(seen >= self.band.t[0]) & (seen <= self.band.t[-1])]
            t = inside if len(inside) > 1 else t
        return _summaries(t, states_at(self.band, t))

    @property
    def paths(self) -> RunPaths:
        """Track, moved to start at the origin along x, unturned without headings; drawn paths."""
        track = None if self.track is None else _from_origin(self.track.poses)
        return RunPaths(track, self.band)


def _summaries(t: Array, states: Array) -> Array:
    """Compute mean speed [m/s], yaw rate [rad/s] and curvature [1/m] of paths, shape (n, 3).

    Speed is length, without noise (`model.travel`), over time; curvature is yaw rate over speed, 0
    for a path of length 0.

    Args:
        t: Times, shape (k,) [s].
        states: x, y, yaw of n paths, shape (n, k, 3) [m, m, rad].
    """
    rows = []
    for state in states:
        poses = Poses.of_states(t, state)
        speed, rate = path_length(poses) / float(np.ptp(t)), mean_yaw_rate(poses)
        rows.append((speed, rate, rate / speed if speed > 0 else 0.0))
    return np.array(rows)


def _quantities(what: str, summaries: list[Array | None]) -> list[Quantity]:
    one, other = summaries
    if one is None or other is None:
        return []
    return [
        Quantity(f"{name}, {what}", unit, (scale * one[:, i], scale * other[:, i]))
        for i, (name, unit, scale) in enumerate(_SUMMARY)
    ]


def _from_origin(poses: Poses) -> Poses:
    turn = -float(poses.yaw[0]) if poses.has_yaw else 0.0
    turned = poses.moved(rotation=turn, translation=[0.0, 0.0])
    return turned.moved(rotation=0.0, translation=-turned.position[0])


def _what(run: _Run) -> str:
    has_yaw = run.track is not None and run.track.poses.has_yaw
    track = "a track" if has_yaw else "a track without headings"
    return " and ".join(name for name, part in ((track, run.track), ("draws", run.band)) if part)
