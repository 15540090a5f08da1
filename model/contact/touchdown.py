# SPDX-License-Identifier: MIT
"""Touchdown and lift-off of each leg in each of its turns, from the contacts of a walk."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.robot import N_LEGS
from model.slip.law import Array

Asked = Sequence[tuple[Array, Array]]
"""Touchdowns that a gait asks for, of each leg: times [s] and unwrapped leg angles [rad]."""


@dataclass(frozen=True)
class Touchdown:
    """First contact of a leg in a turn, and the end of its last; NaN where there is none.

    A turn is from straight up over ahead, down and behind to straight up again.

    Attributes:
        leg: Index of the leg.
        turn: Number of the turn: 0 is that of the angles from -90 to 270 degrees.
        t: Time of the first sample in contact; NaN if the leg does not touch in this turn [s].
        angle: Leg angle at that sample, from -pi/2 to 3/2 pi [rad].
        asked_t: Time at which the gait asked for touchdown; NaN where it is not known [s].
        asked_angle: Leg angle that the gait asked for at touchdown [rad].
        liftoff_t: Time of the first sample after the turn's last contact; NaN if the walk ended
            before [s].
        liftoff_angle: Leg angle at that sample [rad].
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
        The touchdowns, by leg and then by turn.
    """
    found = []
    for leg in range(N_LEGS):
        spans = _spans(t, contact[:, leg], least)
        plan = ([], []) if asked is None else asked[leg]
        wanted = {_turn(angle): (time, angle) for time, angle in zip(*plan, strict=True)}
        found.extend(_of_leg(leg, t, theta[:, leg], spans, wanted))
    return tuple(found)


def _of_leg(
    leg: int,
    t: Array,
    theta: Array,
    spans: list[tuple[int, int]],
    wanted: dict[int, tuple[float, float]],
) -> list[Touchdown]:
    """List one leg's touchdowns from its contacts and those that the gait asked for, by turn."""
    by_turn: dict[int, list[tuple[int, int]]] = {}
    for span in spans:
        by_turn.setdefault(_turn(theta[span[0]]), []).append(span)
    furthest = int(max(_turn(theta.min()), _turn(theta.max())))
    missed = {turn for turn, (time, _) in wanted.items() if t[0] < time and turn < furthest}
    rows = []
    for turn in sorted({*by_turn, *missed}):
        contacts = by_turn.get(turn, [])
        if contacts and contacts[0][0] == 0:
            continue
        asked_t, asked_angle = wanted.get(turn, (np.nan, np.nan))
        first = contacts[0][0] if contacts else None
        last = contacts[-1][1] if contacts and contacts[-1][1] < len(t) else None
        rows.append(
            Touchdown(
                leg, turn, *_at(t, theta, first, turn), float(asked_t),
                _within(asked_angle, turn), *_at(t, theta, last, turn), len(contacts),
            )
        )  # fmt: skip
    return rows


def _spans(t: Array, contact: NDArray[np.bool_], least: float) -> list[tuple[int, int]]:
    """Return first sample of each contact and the first after it, short gaps and contacts gone."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], contact, [False]]).astype(int)))
    spans: list[tuple[int, int]] = []
    for first, after in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if spans and t[first] - t[spans[-1][1]] < least - 1e-9:
            first = spans.pop()[0]
        spans.append((first, after))
    n = len(t)
    return [(i, j) for i, j in spans if i == 0 or j == n or t[j] - t[i] >= least - 1e-9]


def _turn(angle: float) -> int:
    """Return the number of the turn that an unwrapped leg angle is in."""
    return int(np.floor((angle + np.pi / 2) / (2 * np.pi)))


def _within(angle: float, turn: int) -> float:
    """Return an unwrapped angle within its turn [rad]."""
    return float(angle - 2 * np.pi * turn)


def _at(t: Array, theta: Array, sample: int | None, turn: int) -> tuple[float, float]:
    """Return time and angle within a turn at a sample; NaN without one [s, rad]."""
    if sample is None:
        return np.nan, np.nan
    return float(t[sample]), _within(theta[sample], turn)
