# SPDX-License-Identifier: MIT
"""A track on the clock of a prediction: by an offset that is given, or found in the motion."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from model.errors import InsufficientData
from model.metrics.clock import estimate_offset
from model.poses import Poses, overlap
from model.slip.law import Array
from zebro_lab.files.errors import DataError
from zebro_lab.track.file import TrackFile

_STEP = 0.05  # s either side, over which the path's speed is taken


@dataclass(frozen=True)
class SharedClock:
    """A track whose clock is a prediction's.

    Attributes:
        track: The track, its covariance widened by what is not known of the clock.
        offset: What was added to its times [s].
    """

    track: TrackFile
    offset: float


def given_clock(track: TrackFile, offset: float) -> SharedClock:
    """Shift a track's times by a known clock offset.

    Args:
        track: Tracked poses.
        offset: Offset that is added to the times [s].
    """
    return SharedClock(_moved(track, offset), offset)


def estimated_clock(
    track: TrackFile, path: Poses, *, otherwise: str = "Give --time-offset SECONDS"
) -> SharedClock:
    r"""Find the offset of a track's clock in the motion, and say what it leaves open.

    An error of the clock puts every pose ahead or behind by as much time, so the covariance grows
    by :math:`\sigma_\tau^2 v v^T` with v the path's velocity.

    Args:
        track: The track.
        path: The prediction.
        otherwise: What a person may do where the motion does not tell.

    Raises:
        DataError: The motion does not tell the offset.
    """
    try:
        found = estimate_offset(track.poses, path)
    except InsufficientData as error:
        raise DataError(
            f"the clock's offset cannot be estimated: {error}. {otherwise}",
            file=track.file,
        ) from error
    moved = _moved(track, found.value)
    v = _velocity(path, moved.poses.t)
    widened = moved.covariance + found.sd**2 * v[:, :, None] * v[:, None, :]
    note = (
        f"clock: {found.value:+.2f} ± {found.sd:.2f} s were added to the track's times, as the "
        "motion has it; errors along the path are the smaller for it"
    )
    poses = replace(moved.poses, covariance=widened)
    return SharedClock(replace(moved, poses=poses, notes=(*moved.notes, note)), found.value)


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


def _moved(track: TrackFile, offset: float) -> TrackFile:
    return replace(track, poses=track.poses.delayed(offset))


def _velocity(path: Poses, t: Array) -> Array:
    """Return the rates of x, y [m/s] and yaw [rad/s] at times, shape (n, 3)."""
    before, after = (np.clip(t + step, path.t[0], path.t[-1]) for step in (-_STEP, _STEP))
    span = np.maximum(after - before, _STEP)[:, None]
    a, b = path.at(before), path.at(after)
    return np.column_stack([b.position - a.position, b.yaw - a.yaw]) / span
