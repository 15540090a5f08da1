# SPDX-License-Identifier: MIT
"""What holds a walking robot up: flight, contact of the body, load and sliding of legs."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from model.gait.stance import Intervals
from model.robot import N_LEGS
from model.walk.path import WalkPath

SLIDES = 0.01  # m/s: slip velocity above which a leg is said to slide


@dataclass(frozen=True)
class Support:
    """Shares of a walk's samples, which are equally spaced in time.

    Attributes:
        flight: Share in which nothing presses on the ground [-].
        body: Share in which the body presses on the ground; NaN if the model has no contact of
            the body [-].
        loaded: Share in which each leg presses on the ground, shape (6,) [-].
        sliding: Share of each leg's contact with a slip velocity above 10 mm/s; NaN without contact
            or slip, shape (6,) [-].
        unloaded: Share of each leg's stance, by its angles, in which it does not press on the
            ground; NaN without a stance or where the gait is not known, shape (6,) [-].
    """

    flight: float
    body: float
    loaded: Array
    sliding: Array
    unloaded: Array


def support_of(path: WalkPath, stances: Intervals | None = None) -> Support:
    """Compute the shares of a walk's samples in flight, on the body, and with loaded legs.

    Of each leg also how much of its contact it slides, and of its stance it has no contact.

    Args:
        path: The walk, with samples equally spaced in time.
        stances: For each leg, rows (start, end) of the stances by its angles, ends excluded, shape
            (k, 2) [s]; None if not known, as for a log.
    """
    speed = np.linalg.norm(path.slip_velocity, axis=-1)
    slides = np.where(path.contact, speed, np.nan)
    stands = np.zeros(path.contact.shape, dtype=bool)
    for leg, rows in enumerate(() if stances is None else stances):
        first = np.searchsorted(path.t, rows[:, 0], side="right")
        after = np.searchsorted(path.t, rows[:, 1], side="left")
        for i, j in zip(first.tolist(), after.tolist(), strict=True):
            stands[i:j, leg] = True
    body = np.asarray(path.body_force)
    return Support(
        flight=float(path.in_flight.mean()),
        body=float("nan") if np.isnan(body).all() else float(path.on_body.mean()),
        loaded=path.contact.mean(axis=0),
        sliding=_share(slides > SLIDES, ~np.isnan(slides)),
        unloaded=_share(stands & ~path.contact, stands),
    )


def _share(part: NDArray[np.bool_], whole: NDArray[np.bool_]) -> Array:
    """Return, for each leg, the number of samples in `part` over that in `whole`, (6,) [-].

    Both have shape (n, 6); NaN for a leg without a sample in `whole`.
    """
    count = whole.sum(axis=0)
    return np.divide(part.sum(axis=0), count, out=np.full(N_LEGS, np.nan), where=count > 0)
