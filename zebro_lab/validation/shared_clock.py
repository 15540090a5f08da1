# SPDX-License-Identifier: MIT
"""Shift a track to the clock of a prediction, by a known or an estimated clock offset."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.errors import InsufficientData
from model.metrics.clock import ClockOffset, estimate_offset
from model.poses import Poses, overlap
from model.travel import travel_turn, turn_oppositely
from zebro_lab.files.errors import DataError
from zebro_lab.track.file import TrackFile

LARGEST_OFFSET = (
    0.5  # s, and three standard deviations; wrong leg offsets look like a few tenths of a second
)
_STEP = 0.05  # s to either side, for the finite difference of the path's velocity


def shifted(track: TrackFile, offset: float) -> TrackFile:
    """Return a copy of a track with a clock offset added to its times.

    Args:
        track: Tracked poses.
        offset: Offset that is added to the times [s].
    """
    return replace(track, poses=track.poses.delayed(offset))


def estimated_clock(
    track: TrackFile, path: Poses, *, otherwise: str = "Give --time-offset SECONDS"
) -> tuple[TrackFile, float]:
    r"""Estimate a track's clock offset from the motion; add it to its times, its variance to poses.

    A clock error shifts every pose along the path by the same time, so the covariance grows by
    :math:`\sigma_\tau^2 v v^T` with v the path's velocity, and poses get this error in common.

    Args:
        track: The track.
        path: The predicted path, whose clock counts.
        otherwise: What to do if the offset is not determined; part of the error message.

    Returns:
        The track in the prediction's time base, its covariance with the uncertainty of the clock
        offset; and the offset that was added to its times [s].

    Raises:
        DataError: The motion does not determine the offset.
    """
    try:
        found = estimate_offset(track.poses, path)
    except InsufficientData as error:
        why = f"{error}. {otherwise}"
        if turn_oppositely(path, track.poses):
            why = mirrored_hint(track.poses)
        raise DataError(
            f"the clock's offset cannot be estimated: {why}",
            file=track.file,
        ) from error
    moved = shifted(track, found.value)
    v = _velocity(path, moved.poses.t)
    note = (
        f"clock: {found.value:+.2f} ± {found.sd:.2f} s, estimated from the motion, were added to "
        "the track's times; this makes errors along the path smaller"
    )
    poses = replace(moved.poses, joint=moved.joint.also(v, found.sd**2))
    return replace(moved, poses=poses, notes=(*moved.notes, note)), found.value


def clock_difference(
    track: Poses, path: Poses, *, largest: float = LARGEST_OFFSET
) -> ClockOffset | None:
    """Return the offset to add to a track's times if its clock is not the path's; None if it is.

    Args:
        track: Tracked poses.
        path: The predicted path, whose clock counts.
        largest: Offset that is put down to errors of the path, as are three standard deviations if
            these are more [s].

    Raises:
        InsufficientData: The motion does not determine the offset.
    """
    found = estimate_offset(track, path)
    return found if abs(found.value) > max(largest, 3 * found.sd) else None


def mirrored_hint(track: Poses) -> str:
    """Return the question to ask where a track turns to the other side than its prediction does."""
    seen, predicted = ("left", "right") if travel_turn(track) > 0 else ("right", "left")
    return (
        f"predicted turns {predicted}, tracked {seen}, about as sharply: is the plane of the floor "
        "mirrored? Import the track with the plane's axes exchanged, such as --plane zx instead of "
        "xz, or with the other sign of y_m in columns.toml; else check signs and order of the legs"
    )


def shared_time(track: Poses, path: Poses, *, file: Path) -> NDArray[np.bool_]:
    """Return whether each tracked pose lies within the time range of a path, shape (len(track),).

    Args:
        track: The track.
        path: The path.
        file: The track's file, for the error message.

    Raises:
        DataError: Fewer than two tracked poses lie within the path's time range.
    """
    try:
        return overlap(track, path)
    except InsufficientData as error:
        raise DataError(
            f"{error} Give --time-offset SECONDS, which is added to the track's times, or "
            "--estimate-offset",
            file=file,
        ) from error


def _velocity(path: Poses, t: Array) -> Array:
    """Compute rates of x, y [m/s] and yaw [rad/s] at times t by central differences, shape (n, 3).

    At an end of the path the difference is to one side; beyond it the rates are 0.
    """
    before, after = (np.clip(t + step, path.t[0], path.t[-1]) for step in (-_STEP, _STEP))
    span = np.maximum(after - before, _STEP)
    columns = (*path.position.T, path.yaw)
    moved = [np.interp(after, path.t, c) - np.interp(before, path.t, c) for c in columns]
    return np.column_stack(moved) / span[:, None]
