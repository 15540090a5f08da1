# SPDX-License-Identifier: MIT
"""Ways to goals, made up."""

from dataclasses import dataclass

import numpy as np

from model.routes.goal import Goal
from model.routes.manoeuvre import Part
from model.walk.path import WalkPath
from zebro_lab.reach.way import CURVE, Way


@dataclass(frozen=True)
class WalkedStub:
    """The part of a walk that a way uses."""

    path: WalkPath


def made_way(
    manoeuvre=CURVE, *, number=1, time=10.0, done=2.0, end=(1.0, 0.0, 0.0), goal=None, parts=None
):
    """Return a way straight to its end, with work and energies that are easy to tell apart."""
    t, legs = np.array([0.0, time]), np.zeros((2, 6))
    x, y, yaw = end
    path = WalkPath(
        t, np.array([[0.0, 0.0, 0.1], [x, y, 0.1]]), np.array([[0.0] * 3, [0.0, 0.0, yaw]]), legs,
        legs == 0, np.zeros((2, 6, 2)), legs, legs, np.zeros((2, 6, 2)),
        energy=np.array([[0.0] * 4, [done, 1.0, 0.5, 0.2]]),
    )  # fmt: skip
    parts = parts or (Part(0.1, 1.0, 5),)
    return Way(number, goal or Goal(1.0, 0.0), manoeuvre, parts, WalkedStub(path), "curve.toml")
