# SPDX-License-Identifier: MIT
"""Head and tail are told apart by the whole walk, or refused."""

import numpy as np
import pytest

from tracking.body import Alignment, BodyCandidates, resolve_headings
from tracking.errors import AmbiguousHeading
from tracking.pose import BodyPose


def reading(x, yaw, likelihood=0.0, y=0.0):
    state = np.array([x, y, 0.1, 0, 0, yaw])
    return Alignment(BodyPose(state, np.eye(6)), 0.9, likelihood)


def sequence(evidence, step=0.1):
    """A walk along x; `evidence` is how much each photograph prefers the right heading."""
    return [
        BodyCandidates(
            tuple(
                sorted(
                    (reading(step * k, 0.02 * k, e), reading(step * k, 0.02 * k + np.pi)),
                    key=lambda option: -option.log_likelihood,
                )
            )
        )
        for k, e in enumerate(evidence)
    ]


def test_one_photograph_that_is_wrong_is_outvoted_by_the_others():
    chosen = resolve_headings(sequence([3, 4, -5, 3, 4]), length=0.2, walks_ahead=False)
    assert all(np.cos(alignment.pose.state[5]) > 0 for alignment in chosen)


def test_a_robot_alike_at_both_ends_that_stands_still_is_refused():
    with pytest.raises(AmbiguousHeading, match="1000 to 1") as caught:
        resolve_headings(sequence([0.1] * 6, step=0.0), length=0.2)
    assert caught.value.odds < 1000


def test_no_flip_in_a_thousand_sequences():
    rng = np.random.default_rng(4)
    for _ in range(1000):
        chosen = resolve_headings(sequence(rng.normal(0.5, 3.0, 8)), length=0.2)
        assert all(np.cos(alignment.pose.state[5]) > 0 for alignment in chosen)
