# SPDX-License-Identifier: MIT
"""The part of a walk that figures over time show: a window, or the last cycles of walking."""

import numpy as np

from model.arrays import Array
from model.walk.path import WalkPath
from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.picture_options import Window

_SHOWN_CYCLES = 2.0
_STOPPED = 0.01  # of a turn: closer to their last angles the legs have stopped
_AFTER = 0.1  # s of standing that are shown after the last step


def leg_turns(path: WalkPath) -> Array:
    """Compute how far the legs have turned, from the first sample on, shape (n,) [turns].

    This is the mean over the legs, each counted positive in the direction in which it turned from
    start to end, so that both sides count when the robot turns on the spot. A running maximum keeps
    it from falling.

    Args:
        path: The walk.
    """
    own = np.sign(path.theta[-1] - path.theta[0])
    turned = (own * path.theta).mean(axis=1)
    return (np.maximum.accumulate(turned) - turned[0]) / (2 * np.pi)


def last_cycles(path: WalkPath) -> WalkPath:
    """Return the last two cycles of walking, with 0.1 s of what follows; two samples at least.

    A cycle is a turn of the legs. Time in which the robot stands before and after is left out. A
    walk of fewer cycles is returned from its first step on, one without any step whole.

    Args:
        path: The walk.
    """
    turns = leg_turns(path)
    stop = float(turns[-1]) - _STOPPED
    if stop <= 0:
        return path
    end = path.t[np.searchsorted(turns, stop)] + _AFTER
    first = np.searchsorted(turns, max(turns[-1] - _SHOWN_CYCLES, _STOPPED), side="right") - 1
    begin = path.t[max(first, 0)]
    return _between(path, begin, end)


def part_in(path: WalkPath, window: Window | None) -> WalkPath:
    """Return the part of a walk in a window of time; without a window its last two cycles.

    Args:
        path: The walk.
        window: Begin and end [s]; None for the last two cycles of walking.

    Raises:
        SettingsError: The window holds fewer than two samples of the walk.
    """
    if window is None:
        return last_cycles(path)
    part = path.part((path.t >= window.begin - 1e-9) & (path.t <= window.end + 1e-9))
    if len(part.t) < 2:
        raise SettingsError(
            f"found {window.begin:g}:{window.end:g} s; expected a time of the walk, which lasts "
            f"from {path.t[0]:g} to {path.t[-1]:g} s",
            key="--window",
        )
    return part


def require_shown_times(
    at: tuple[float, ...], window: Window | None, begin: float, end: float
) -> None:
    """Check that the times to draw are times of the walk, before it is computed.

    Args:
        at: Times of snapshots [s].
        window: Window of time; None for none.
        begin: First time of the walk [s].
        end: Last time of the walk [s].

    Raises:
        SettingsError: A snapshot, or all of the window, lies outside the walk.
    """
    outside = [t for t in at if not begin - 1e-9 <= t <= end + 1e-9]
    if outside:
        raise SettingsError(
            f"found {outside[0]:g} s; expected times of the walk, {begin:g} to {end:g} s",
            key="--at",
        )
    if window is not None and not (window.begin < end and window.end > begin):
        raise SettingsError(
            f"found {window.begin:g}:{window.end:g} s; expected a part of the walk, {begin:g} to "
            f"{end:g} s",
            key="--window",
        )


def _between(path: WalkPath, begin: float, end: float) -> WalkPath:
    """Return the samples from begin to end [s], but at least two, up to the end."""
    first = int(np.searchsorted(path.t, begin - 1e-9))
    last = int(np.searchsorted(path.t, end + 1e-9))
    first = max(min(first, last - 2), 0)
    return path.part(slice(first, last))
