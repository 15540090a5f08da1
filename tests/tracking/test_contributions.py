# SPDX-License-Identifier: MIT
"""A cause's contribution is the variance that goes when the cause becomes known."""

import numpy as np
import pytest

from tracking.constant_twist import Process
from tracking.contributions import ADVICE, contributions, shared_part
from tracking.path import PoseObservation, Track, assemble_track
from tracking.pose import BodyPose, BodyPrior
from tracking.shared import LENS, MARKS, SIDE, SharedErrors, mark_name

PRIOR = BodyPrior(0.06)
MOVES_X = np.eye(6)[:, :1]
TURNS = np.eye(6)[:, 5:]


def track(spreads: dict[str, tuple[np.ndarray, float]]) -> Track:
    """Track a straight walk of given shared errors: derivative of the pose, standard deviation."""
    shared = SharedErrors.none()
    for cause, (_, sd) in spreads.items():
        shared = shared.also(cause, np.array([[sd**2]]))
    by_cause = {cause: by for cause, (by, _) in spreads.items()}
    seen = [
        PoseObservation(
            f"{k}.jpg", float(k), 0.0,
            BodyPose(np.array([0.1 * k, 0, 0.06, 0, 0, 0]), 1e-6 * np.eye(6), by_cause), 1.0,
            "marker",
        )
        for k in range(8)
    ]  # fmt: skip
    return assemble_track(seen, shared=shared, prior=PRIOR, process=Process(1e-6, 1e-6, sway=0.0))


def test_the_cause_of_most_of_the_variance_comes_first_with_its_advice():
    found = contributions(track({SIDE: (MOVES_X, 1e-3), LENS: (MOVES_X, 1e-2)}))
    assert [each.cause for each in found] == [LENS, SIDE]
    assert found[0].position == pytest.approx(1e-4 / (1e-4 + 1e-6), abs=0.01)
    assert found[1].position == pytest.approx(1e-6 / (1e-4 + 1e-6), abs=0.01)
    assert found[0].yaw == pytest.approx(0.0, abs=1e-9)
    assert found[0].advice == ADVICE[LENS]


def test_marks_are_one_cause_and_position_is_apart_from_heading():
    found = contributions(track({mark_name(1): (MOVES_X, 1e-2), mark_name(2): (TURNS, 1e-2)}))
    (both,) = found
    assert both.cause == MARKS
    assert both.position > 0.9
    assert both.yaw > 0.9


def test_all_causes_together_take_what_does_not_average_out():
    walk = track({SIDE: (MOVES_X, 1e-3), LENS: (MOVES_X, 1e-3)})
    single = max(each.position for each in contributions(walk))
    position, yaw = shared_part(walk)
    assert single + 0.2 < position < 1.0
    assert yaw == pytest.approx(0.0, abs=1e-9)


def test_a_walk_without_shared_errors_has_no_part_of_them():
    walk = track({})
    assert contributions(walk) == ()
    np.testing.assert_allclose(shared_part(walk), 0.0, atol=1e-12)
