# SPDX-License-Identifier: MIT
"""Compute the errors of a run's prediction against its track."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from model.counted import counted
from model.errors import InsufficientData
from model.judgement import Judgement, TiltJudged, judge
from model.metrics.consistency import FEWEST_DRAWS
from model.path_draws import states_at
from model.poses import Poses
from model.travel import turn_oppositely
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.track.file import TrackFile
from zebro_lab.validation.extents import unit_warning
from zebro_lab.validation.shared_clock import clock_difference, mirrored_hint, shared_time
from zebro_lab.walk.prediction_file import PredictionFile

_GAP: Final = 5.0
"""Times the usual time between poses, from which on poses are missing."""
_NEAR: Final = 0.2
"""Largest relative difference of the ratio of extents from a large factor between two units [-]."""


@dataclass(frozen=True)
class JudgedRun(Judgement):
    """Errors of a walk's prediction and baselines against its track.

    Attributes:
        name: Name of the walk.
        notes: Notes, one line each.
        tilt: Errors of roll and pitch against the IMU; None if not compared, as without an IMU.
    """

    name: str
    notes: tuple[str, ...]
    tilt: TiltJudged | None = None


def judge_run(
    name: str,
    predicted: PredictionFile,
    track: TrackFile,
    *,
    anchor: bool,
    rng: np.random.Generator,
) -> JudgedRun:
    """Compute the errors of a prediction and its baselines against a track; without roll and pitch.

    Args:
        name: Name of the walk.
        predicted: The prediction with its baselines.
        track: The track, in the prediction's time base.
        anchor: Whether every path starts from the first tracked pose, which is then not scored.
        rng: Random number generator.

    Raises:
        DataError: Fewer than two tracked poses to score lie within the time of the prediction.
        SettingsError: Anchoring is requested, and the first pose within that time has no heading.
    """
    inside = shared_time(track.poses, predicted.prediction.path, file=track.file)
    if inside.sum() - anchor < 2:
        raise DataError(
            "tracked poses to score within the predicted time, without the first if paths start "
            f"from it: {max(int(inside.sum()) - anchor, 0)}; expected two or more: track more "
            "photographs of that time or try --no-anchor",
            file=track.file,
        )
    if anchor and not np.isfinite(track.poses.yaw[inside][0]):
        raise SettingsError(
            "the track has no headings (column yaw_rad), so its first pose cannot start a "
            "prediction; use --no-anchor and look at the aligned errors",
            key="--anchor",
        )
    judgement = judge(predicted.prediction, track.poses, anchor=anchor, rng=rng)
    seen = track.poses.part(inside)
    notes = (
        *_sizes(judgement, track), *track.notes, *predicted.notes,
        *_outside(inside, predicted.prediction.path.t), *_gaps(seen.t),
        *_mirrored(seen, predicted.prediction.path),
        *_clock(track.poses, predicted.prediction.path), *_not_testable(judgement),
    )  # fmt: skip
    return JudgedRun(judgement.track, judgement.rows, judgement.band, name, notes)


def _sizes(judgement: Judgement, track: TrackFile) -> tuple[str, ...]:
    """Return a question if track and prediction extend as if their units differed; else empty."""
    seen = judgement.track
    path = states_at(judgement.rows[0].path.draws(), seen.t)[0, :, :2]
    return unit_warning(
        (seen.position, f"the track {track.file}"), (path, "its prediction"), near=_NEAR
    )


def _outside(inside: np.ndarray, t: np.ndarray) -> Iterator[str]:
    """Yield a note if tracked poses lie outside the predicted times `t`, a warning if most do."""
    left_out, total = int((~inside).sum()), len(inside)
    if 2 * left_out > total:
        yield (
            f"WARNING: the whole walk is not testable with these data: only {total - left_out} of "
            f"{total} tracked poses lie within the predicted time, {t[0]:g} to {t[-1]:g} s; is it "
            "the prediction of another walk? Predict the time of the track, or correct its clock "
            "with --time-offset"
        )
    elif left_out:
        lie = "lies" if left_out == 1 else "lie"
        yield (
            f"{counted(left_out, 'tracked pose')} {lie} outside the predicted time and "
            f"{'is' if left_out == 1 else 'are'} not scored"
        )


def _gaps(t: Array) -> Iterator[str]:
    """Yield a note if steps between the times `t` [s] are over `_GAP` times their median."""
    steps = np.diff(t)
    usual = float(np.median(steps))
    gaps = steps[steps > _GAP * usual]
    if len(gaps):
        yield (
            f"the track has {counted(len(gaps), 'gap')}, the longest of {gaps.max():.3g} s: "
            f"{(gaps - usual).sum():.3g} of {np.ptp(t):.3g} s are without poses, and not scored"
        )


def _mirrored(track: Poses, path: Poses) -> Iterator[str]:
    """Yield a warning if the track turns to the other side than the predicted path at its times."""
    if turn_oppositely(path.at(track.t), track):
        yield f"WARNING: {mirrored_hint(track)}"


def _clock(track: Poses, path: Poses) -> Iterator[str]:
    """Yield a warning if the motion shows another clock than the path's, or what is not testable.

    A track that turns to the other side is skipped, since `_mirrored` warns of it.
    """
    if turn_oppositely(path, track):
        return
    try:
        found = clock_difference(track, path)
    except InsufficientData:
        yield (
            "the track's clock: not testable, as this motion does not determine its offset; let "
            "the robot start and stop in view"
        )
        return
    if found is not None:
        yield (
            f"WARNING: by the motion the track's clock is {found.value:+.1f} ± {found.sd:.1f} s "
            "behind the prediction's, which is scored as an error along the path: add that to its "
            "times with --time-offset, or give --estimate-offset"
        )


def _not_testable(judgement: Judgement) -> Iterator[str]:
    """Yield a line for each judgement on the band that prediction or track do not allow."""
    if judgement.band is None:
        yield "coverage and consistency: not testable without a band; predict with --draws"
        return
    if (draws := len(judgement.band.position)) < FEWEST_DRAWS:
        yield (
            f"consistency of the band: not testable with {draws} draws; expected {FEWEST_DRAWS} "
            "or more: predict with --draws"
        )
    if not np.isfinite(judgement.track.yaw).all():
        yield (
            "coverage and consistency of yaw: not testable, as tracked poses have no heading "
            "(column yaw_rad)"
        )
