# SPDX-License-Identifier: MIT
"""Describe how measured legs turn: direction, centre of stance, phase in the gait.

A leg turns slowly on the ground and fast in flight. Counted per angle that all legs have turned on
average, instead of per second, it therefore spends most of a walk on the ground, whether the robot
starts slowly, stands still for a while or changes its speed.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.robot import N_LEGS

PACE: Final = np.pi / 30
"""Mean rotation of the legs from one row to the next [rad]."""
FEWEST: Final = 1.0
"""Least rotation that is judged [turns]."""
CLEAR: Final = 0.2
"""Least `weight` with which a centre of stance is known; a tripod's is about 0.35 [-]."""
_AS_ONE: Final = 0.8  # length of the mean of exp(i phase) above which all legs step at once
_STEADY: Final = 0.8  # share of a leg's travel that must be in one direction
_STILL: Final = 0.2  # share of the typical pace below which the robot stands
_ENOUGH: Final = np.radians(6)  # mean rotation between samples that exceeds steps of an encoder


@dataclass(frozen=True)
class LegMotion:
    """How six legs turned in a walk; nothing here depends on the time that it took.

    Attributes:
        turns: Rotation of each leg, there and back, shape (6,) [turns].
        direction: 1 or -1 where a leg's angle grew or fell most of the time, else 0, shape (6,).
        centre: Circular mean of each leg angle, which is that of the middle of its stance, in
            (-pi, pi], shape (6,) [rad].
        weight: Mean resultant length, that of the mean of exp(i theta), from 0 for a leg that turns
            evenly to 1 for one that stands still, shape (6,) [-]. 0 where all legs step at once,
            since then their mean rotation says nothing of their stance.
        phase: Share of its cycle by which each leg is ahead of leg 1, in [0, 1), shape (6,)
            [cycles]. Independent of the zero and of the sign of its angle where `weight` is clear.
        coherence: 1 where the differences of phase are constant, 1/6 where they are arbitrary [-].
    """

    turns: Array
    direction: Array
    centre: Array
    weight: Array
    phase: Array
    coherence: float

    @property
    def turning(self) -> NDArray[np.bool_]:
        """Whether each leg turned by `FEWEST` turns, so that it can be judged, shape (6,)."""
        return self.turns >= FEWEST


def leg_motion(theta: Array) -> LegMotion | None:
    """Describe the motion of legs; None where they turn by less than `FEWEST` on average.

    Args:
        theta: Unwrapped leg angles in the order of time, shape (n, 6) [rad].
    """
    rows = _by_pace(theta)
    if len(rows) * PACE < 2 * np.pi * FEWEST:
        return None
    net, travel = rows[-1] - rows[0], np.abs(np.diff(rows, axis=0)).sum(axis=0)
    mean = np.exp(1j * rows).mean(axis=0)
    direction = np.where(np.abs(net) > _STEADY * travel, np.sign(net), 0)
    centre, weight = np.angle(mean), np.abs(mean)
    middle = np.where(weight >= CLEAR, centre, np.pi / 2)
    phase, coherence = _phases(np.where(direction < 0, -1, 1) * (rows - middle))
    if np.abs(np.exp(2j * np.pi * phase).mean()) > _AS_ONE:
        weight = np.zeros(N_LEGS)
    return LegMotion(travel / (2 * np.pi), direction, centre, weight, phase, coherence)


def _by_pace(theta: Array) -> Array:
    """Resample leg angles at steps `PACE` of the legs' mean rotation, without rows at rest.

    Samples are thinned out, by factors of two, until the typical rotation between them exceeds
    `_ENOUGH`; at rest are those that rotate by less than `_STILL` of it. The result has shape
    (m, 6), m = 0 where nothing moves or fewer than three samples are left.
    """
    every, typical, rows, steps = 1, 0.0, theta, np.zeros(0)
    while typical < _ENOUGH:
        rows = theta[::every]
        steps = np.abs(np.diff(rows, axis=0)).mean(axis=1)
        if len(steps) < 2 or not steps.any():
            return np.zeros((0, N_LEGS))
        typical, every = float((steps**2).sum() / steps.sum()), 2 * every
    moving = np.nonzero(steps > _STILL * typical)[0]
    turned = np.concatenate([[0.0], np.cumsum(steps[moving])])
    kept = rows[np.concatenate([moving[:1], moving + 1])]
    at = np.arange(0.0, turned[-1], PACE)
    return np.column_stack([np.interp(at, turned, column) for column in kept.T])


def _phases(angle: Array) -> tuple[Array, float]:
    """Return the phase of each leg ahead of leg 1 [cycles], and how constant they are.

    The phase within a cycle is the rank of the angle among all, which grows evenly; the phases of
    the legs are those of the leading eigenvector of their mutual coherence.

    Args:
        angle: Angle of each leg from the middle of its stance, growing, shape (n, 6) [rad].
    """
    within = (angle + np.pi) % (2 * np.pi)
    share = (within.argsort(axis=0).argsort(axis=0) + 0.5) / len(within)
    turned = np.exp(2j * np.pi * share)
    values, vectors = np.linalg.eigh(turned.T @ turned.conj() / len(turned))
    phase = np.angle(vectors[:, -1] / vectors[0, -1]) / (2 * np.pi)
    return phase % 1.0, float(values[-1]) / N_LEGS
