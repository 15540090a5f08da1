# SPDX-License-Identifier: MIT
"""How far two walks by the same leg angles are apart."""

from dataclasses import dataclass

import numpy as np

from benchmarks.accuracy.rigid_engine.walking import EnginePath
from model.arrays import Array
from model.robot import N_LEGS

CARRIES = 0.02  # N, a thousandth of the robot's weight; a leg with more is in contact


@dataclass(frozen=True)
class Motion:
    """A walk to compare: where the body was, and what the legs carried.

    Attributes:
        t: Times [s], shape (n,).
        xy: Centre of the body, shape (n, 2) [m].
        yaw: Heading, unwrapped, shape (n,) [rad].
        load: Normal force on each leg, shape (n, 6) [N].
    """

    t: Array
    xy: Array
    yaw: Array
    load: Array


@dataclass(frozen=True)
class Agreement:
    """How far a walk is from the engine's.

    Attributes:
        path: Root mean square distance over the length walked [-].
        heading: Largest difference of heading over the whole turn, left and right added; NaN
            without a turn of 10 degrees [-].
        contacts: Share of the time, mean over the legs, in which both say that a leg is in
            contact or both that it is not [-].
    """

    path: float
    heading: float
    contacts: float


def motion_of(path: EnginePath) -> Motion:
    """Return what is compared of the engine's walk."""
    return Motion(path.t, path.position[:, :2], path.yaw, path.load)


def agreement(ours: Motion, engine: Motion, *, turned: float | None = None) -> Agreement:
    """Compare a walk with the engine's at the engine's times.

    Args:
        ours: The walk, sampled at least as often.
        engine: The engine's walk; its loads are means since the sample before.
        turned: What the heading is compared with; the sum of the engine's changes of heading,
            over half a second each, when None [rad].
    """
    t = engine.t
    xy = np.column_stack([np.interp(t, ours.t, each) for each in ours.xy.T])
    apart = np.linalg.norm(xy - engine.xy, axis=1)
    yaw = np.interp(t, ours.t, ours.yaw)
    turned = whole_turn(engine) if turned is None else turned
    return Agreement(
        path=float(np.sqrt((apart**2).mean()) / length(engine)),
        heading=float(np.abs(yaw - engine.yaw).max() / turned)
        if turned > np.radians(10.0)
        else np.nan,
        contacts=float(((loads_between(ours, t) > CARRIES) == (engine.load[1:] > CARRIES)).mean()),
    )


def loads_between(walk: Motion, t: Array) -> Array:
    """Return the mean loads of a walk between times, shape (len(t) - 1, 6) [N]."""
    gained = np.zeros_like(walk.load)
    # A sample holds for the step that ends at it.
    gained[1:] = np.cumsum(walk.load[1:] * np.diff(walk.t)[:, None], axis=0)
    at = np.column_stack([np.interp(t, walk.t, gained[:, leg]) for leg in range(N_LEGS)])
    return np.diff(at, axis=0) / np.diff(t)[:, None]


def length(walk: Motion, every: float = 0.1) -> float:
    """Return the length of a walk, by steps of a tenth of a second [m]."""
    at = np.arange(walk.t[0], walk.t[-1] + 0.5 * every, every)
    xy = np.column_stack([np.interp(at, walk.t, each) for each in walk.xy.T])
    return float(np.linalg.norm(np.diff(xy, axis=0), axis=1).sum())


def whole_turn(walk: Motion, every: float = 0.5) -> float:
    """Return the sum of the changes of heading, left and right, by steps of half a second [rad]."""
    at = np.arange(walk.t[0], walk.t[-1] + 0.5 * every, every)
    return float(np.abs(np.diff(np.interp(at, walk.t, walk.yaw))).sum())
