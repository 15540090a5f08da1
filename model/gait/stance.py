# SPDX-License-Identifier: MIT
"""Stance intervals of each leg: the bars of a Gantt chart."""

import numpy as np
from numpy.typing import ArrayLike

from model.arrays import Array
from model.errors import DomainError

Intervals = tuple[Array, ...]  # by leg; rows of start and end, shape (k, 2) [s]


def stance_intervals(t: Array, theta: Array, touchdown: ArrayLike, liftoff: ArrayLike) -> Intervals:
    """Compute the intervals in which leg angles, modulo a turn, are from touchdown to lift-off.

    Angles are interpolated linearly between the samples; the sense of rotation does not matter.

    Args:
        t: Times, increasing, shape (m,) [s].
        theta: Leg angles, unwrapped, shape (m, n) [rad].
        touchdown: Touchdown angles, a number or shape (n,) [rad].
        liftoff: Lift-off angles, beyond touchdown by less than a turn, as `touchdown` [rad].

    Returns:
        One array of rows (start, end) for each leg [s].

    Raises:
        DomainError: A lift-off angle does not exceed touchdown, or does by a turn or more.

    >>> theta = np.array([[0.0], [np.pi], [2 * np.pi]])
    >>> stance_intervals(np.array([0.0, 1.0, 2.0]), theta, np.pi / 4, np.pi / 2)[0].tolist()
    [[0.25, 0.5]]
    """
    n_legs = theta.shape[1]
    down, up = (np.broadcast_to(np.asarray(x, dtype=float), n_legs) for x in (touchdown, liftoff))
    require_stance_angles(down, up)
    return tuple(
        _leg_intervals(t, theta[:, leg] - down[leg], float(up[leg] - down[leg]))
        for leg in range(n_legs)
    )


def event_intervals(touchdown: Array, liftoff: Array, span: tuple[float, float]) -> Intervals:
    """Pair touchdown times with lift-off times to stance intervals inside a span.

    Args:
        touchdown: Times at which legs come down, in order, shape (k, n) [s].
        liftoff: Times at which the same stances end, shape (k, n) [s].
        span: Start and end of the chart; intervals are cut there and dropped outside [s].

    Returns:
        One array of rows (start, end), shape (up to k, 2), for each leg [s].
    """
    pairs = np.clip(np.stack([touchdown, liftoff], axis=-1), *span)
    return tuple(leg[leg[:, 1] > leg[:, 0]] for leg in pairs.swapaxes(0, 1))


def require_stance_angles(touchdown: Array, liftoff: Array) -> None:
    """Check that each leg's stance angle lies between zero and a turn.

    Args:
        touchdown: Touchdown angles, shape (n,) [rad].
        liftoff: Lift-off angles, shape (n,) [rad].

    Raises:
        DomainError: A stance angle is not between 0 and 2 pi.
    """
    for leg, (down, up) in enumerate(zip(touchdown, liftoff, strict=True), start=1):
        if not 0 < up - down < 2 * np.pi:
            raise DomainError(
                f"leg {leg} touches down at {np.degrees(down):g} and lifts off at "
                f"{np.degrees(up):g} degrees; expected lift-off beyond touchdown, by less than "
                "360 degrees"
            )


def _leg_intervals(t: Array, past_touchdown: Array, stance_angle: float) -> Array:
    """Return rows (start, end), shape (k, 2), of the times on the ground of one leg [s].

    Args:
        t: Times, increasing, shape (m,) [s].
        past_touchdown: Leg angle less touchdown angle, linear between the times, (m,) [rad].
        stance_angle: Stance angle; modulo a turn, smaller angles are on the ground [rad].
    """
    knots = np.unique(
        np.concatenate(
            [
                t[[0, -1]],
                _crossings(t, past_touchdown),
                _crossings(t, past_touchdown - stance_angle),
            ]
        )
    )
    middle = np.interp((knots[:-1] + knots[1:]) / 2, t, past_touchdown)
    stands = np.concatenate([[False], middle % (2 * np.pi) < stance_angle, [False]])
    starts, ends = (
        np.flatnonzero(change) for change in (np.diff(stands * 1) > 0, np.diff(stands * 1) < 0)
    )
    return np.column_stack([knots[starts], knots[ends]])


def _crossings(t: Array, angle: Array) -> Array:
    """Compute the times [s] at which an angle, linear between samples, crosses a multiple of 2 pi.

    They are sorted by the multiple, not by time; there may be none.
    """
    turns = angle / (2 * np.pi)
    levels = np.arange(np.ceil(turns.min()), np.floor(turns.max()) + 1)
    found = [_level_crossings(t, turns - level) for level in levels]
    return np.concatenate(found) if found else np.empty(0)


def _level_crossings(t: Array, value: Array) -> Array:
    """Compute the times at which a value, linear between samples, crosses zero [s]."""
    before, after = value[:-1], value[1:]
    at = np.flatnonzero((before <= 0) != (after <= 0))
    share = before[at] / (before[at] - after[at])
    return t[at] + share * (t[at + 1] - t[at])
