# SPDX-License-Identifier: MIT
"""Touchdown and lift-off of each leg in each of its turns, from the contacts of a walk."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from model.robot import N_LEGS

Asked = Sequence[tuple[Array, Array]]
"""Touchdowns that a gait asks for, of each leg: times [s] and unwrapped leg angles [rad]."""


@dataclass(frozen=True)
class Touchdown:
    """First contact of a leg in a turn, and the end of its last; NaN where there is none.

    A turn is from straight up over ahead, down and behind to straight up again. Where the gait asks
    for touchdowns, it ends where the leg points up most between two of them: legs that swing to and
    fro touch down in their turn each time.

    Attributes:
        leg: Index of the leg.
        turn: Number of the turn: 0 is that of the angles from -90 to 270 degrees. Legs that go back
            come through a turn again.
        t: Time of the first sample in contact; NaN if the leg does not touch in this turn [s].
        angle: Leg angle at that sample, from -pi/2 to 3/2 pi [rad].
        asked_t: Time at which the gait asked for touchdown; NaN where it is not known [s].
        asked_angle: Leg angle that the gait asked for at touchdown, less the same whole turns as
            `angle`; NaN where it is not known [rad].
        liftoff_t: Time of the first sample after the turn's last contact; NaN if the walk ended
            before [s].
        liftoff_angle: Leg angle at that sample, less the same whole turns as `angle`, so that it is
            beyond 3/2 pi in the next turn; NaN as `liftoff_t` [rad].
        contacts: Number of times that the leg touched down in this turn.
    """

    leg: int
    turn: int
    t: float
    angle: float
    asked_t: float
    asked_angle: float
    liftoff_t: float
    liftoff_angle: float
    contacts: int

    @property
    def late(self) -> float:
        """Time from the touchdown that the gait asked for to the touchdown [s]."""
        return self.t - self.asked_t


def touchdowns(
    t: Array,
    theta: Array,
    contact: NDArray[np.bool_],
    *,
    asked: Asked | None = None,
    least: float = 0.0,
) -> tuple[Touchdown, ...]:
    """List the touchdowns of each leg, a row for each of its turns.

    A leg that stands at the first sample has touched down before the walk: that turn is left out.
    A turn without contact is listed if the gait asked for a touchdown and the leg turned on.

    Args:
        t: Times of the samples, increasing, shape (n,) [s].
        theta: Leg angles, unwrapped, shape (n, 6) [rad].
        contact: Which legs are on the ground, shape (n, 6).
        asked: Touchdowns that the gait asks for; None if they are not known, as of a log.
        least: Shorter gaps in the contact of a leg do not end it, and shorter contacts do not
            count [s].

    Returns:
        The touchdowns, by leg and then by time.
    """
    found = []
    for leg in range(N_LEGS):
        spans = _spans(t, contact[:, leg], least)
        if asked is None:
            turn = _turn(theta[:, leg])
            found.extend(_of_leg(leg, t, theta[:, leg], spans, turn - turn.min(), {}))
        else:
            step, wanted = _steps(t, theta[:, leg], *asked[leg])
            found.extend(_of_leg(leg, t, theta[:, leg], spans, step, wanted))
    return tuple(found)


def _steps(
    t: Array, theta: Array, times: Array, angles: Array
) -> tuple[NDArray[np.intp], dict[int, tuple[float, float]]]:
    """Return the number of each sample's step, (n,), and the touchdown asked for in each step.

    Between two touchdowns a step ends where the leg points up most; step 0 is before the first.
    """
    step, begin = np.zeros(len(t), dtype=np.intp), 0
    for time in times:
        end = int(np.searchsorted(t, time - 1e-9)) + 1
        between = np.sin(theta[begin:end])
        top = begin + int(between.argmin()) if len(between) else begin
        step[top:] += 1
        begin = end
    wanted = zip(map(float, times), map(float, angles), strict=True)
    return step, dict(enumerate(wanted, start=1))


def _of_leg(
    leg: int,
    t: Array,
    theta: Array,
    spans: list[tuple[int, int]],
    step: NDArray[np.intp],
    wanted: dict[int, tuple[float, float]],
) -> list[Touchdown]:
    """List one leg's touchdowns, one for each step that has a contact or a missed touchdown.

    The step of a leg that stands at the first sample is left out. A touchdown that the gait asked
    for is missed if its step has no contact, and the leg is in a later step or another turn at the
    last sample.

    Args:
        leg: Index of the leg.
        t: Times of the samples, shape (n,) [s].
        theta: Unwrapped leg angle, shape (n,) [rad].
        spans: First sample of each contact, and the first one after it.
        step: Number of each sample's step, shape (n,).
        wanted: Time [s] and unwrapped angle [rad] of the touchdown asked for, by step.
    """
    by_step: dict[int, list[tuple[int, int]]] = {}
    for span in spans:
        by_step.setdefault(int(step[span[0]]), []).append(span)
    last_turn = _turn(theta[-1])
    missed = {
        number for number, (time, angle) in wanted.items()
        if t[0] < time and (number < step[-1] or _turn(angle) != last_turn)
    }  # fmt: skip
    rows = []
    for number in sorted({*by_step, *missed}):
        contacts = by_step.get(number, [])
        if contacts and contacts[0][0] == 0:
            continue
        asked_t, asked_angle = wanted.get(number, (np.nan, np.nan))
        first = contacts[0][0] if contacts else None
        turn = int(_turn(asked_angle if first is None else theta[first]))
        last = contacts[-1][1] if contacts and contacts[-1][1] < len(t) else None
        rows.append(
            Touchdown(
                leg, turn, *_at(t, theta, first, turn), asked_t,
                _within(asked_angle, turn), *_at(t, theta, last, turn), len(contacts),
            )
        )  # fmt: skip
    return rows


def _spans(t: Array, contact: NDArray[np.bool_], least: float) -> list[tuple[int, int]]:
    """Return the first sample of each contact of a leg, and the first sample after it.

    Gaps shorter than `least` [s] are closed, then contacts shorter than it are left out, unless
    they touch the first or last sample: how long those last is not known.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], contact, [False]]).astype(int)))
    spans: list[tuple[int, int]] = []
    for first, after in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if spans and t[first] - t[spans[-1][1]] < least - 1e-9:
            first = spans.pop()[0]
        spans.append((first, after))
    n = len(t)
    return [(i, j) for i, j in spans if i == 0 or j == n or t[j] - t[i] >= least - 1e-9]


def _turn(angle: ArrayLike) -> NDArray[np.intp]:
    """Return the number of the turn of each unwrapped leg angle; turn 0 is -90 to 270 degrees."""
    return np.floor((np.asarray(angle) + np.pi / 2) / (2 * np.pi)).astype(np.intp)


def _within(angle: float, turn: int) -> float:
    """Return an unwrapped angle less `turn` turns: from -pi/2 to 3/2 pi in that turn [rad]."""
    return float(angle - 2 * np.pi * turn)


def _at(t: Array, theta: Array, sample: int | None, turn: int) -> tuple[float, float]:
    """Return time [s] and angle less whole turns [rad] at a sample; NaN if `sample` is None."""
    if sample is None:
        return np.nan, np.nan
    return float(t[sample]), _within(theta[sample], turn)
