# SPDX-License-Identifier: MIT
"""A posterior after walks that is sure of its answer."""

import numpy as np

from model.bayes.walks.posterior import WalkPosterior
from model.bayes.walks.prior import LINEAR, NAMES, WRONG, WalkPrior, WrongLeg, all_cases

STEERING = LINEAR[0]


GRIP = NAMES.index("grip")


KNOCKED = WrongLeg(2, walk=1)


OFF = np.radians(5.0)


def posterior_of(case, *, steering=0.0):
    """Return a posterior that is sure: leg 3 off by 5 degrees in `case`, all else as described."""
    cases = all_cases(2)
    values = np.zeros((40, WRONG + 1))
    values[:, WRONG], values[:, STEERING] = OFF, steering
    values[:, GRIP] = WalkPrior().grip_sd * np.linspace(-1.7, 1.7, len(values))  # not informed
    n = len(values)
    return WalkPosterior(
        prior=WalkPrior(),
        walks=("one", "two"),
        cases=cases,
        values=values,
        case=np.full(n, cases.index(case)),
        weight=np.full(n, 1 / n),
        best=values[20],
        best_case=case,
        misfit=(0.9, 1.1),
    )
