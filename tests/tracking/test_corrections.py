# SPDX-License-Identifier: MIT
"""Corrections say what they mean, change nothing else, and come back from plain values."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.corrections import Delete, Flip, Move, correction_from, plain, replay
from tracking.errors import CorrectionError
from tracking.path import PoseObservation
from tracking.pose import BodyPose, BodyPrior
from tracking.shared import LENS, PLACE

PRIOR = BodyPrior(0.1)


def seen(index: int) -> PoseObservation:
    pose = BodyPose(np.array([0.1 * index, 0.0, 0.1, 0.0, 0.0, 0.2]), 1e-6 * np.eye(6))
    return PoseObservation(f"p{index}.jpg", 2.0 * index, 0.01, pose, 0.9, "marker")


WALK = tuple(seen(index) for index in range(4))
NAMES = st.sampled_from([observation.photo for observation in WALK])
NUMBER = st.floats(-10, 10)
CORRECTIONS = st.one_of(
    st.builds(Move, NAMES, NUMBER, NUMBER, NUMBER),
    st.builds(Flip, NAMES),
)


@given(st.lists(CORRECTIONS, max_size=6))
def test_plain_values_bring_corrections_back(corrections):
    again = [correction_from(plain(correction)) for correction in corrections]
    assert again == corrections


def test_flipping_twice_is_nothing():
    (again, *_) = replay(WALK, [Flip("p0.jpg"), Flip("p0.jpg")], prior=PRIOR)
    np.testing.assert_allclose(again.planar, WALK[0].planar, atol=1e-12)
    (once, *_) = replay(WALK, [Flip("p0.jpg")], prior=PRIOR)
    assert np.cos(once.planar[2] - WALK[0].planar[2]) == pytest.approx(-1)


def test_deleting_takes_one_away():
    assert [o.photo for o in replay(WALK, [Delete("p1.jpg")], prior=PRIOR)] == [
        "p0.jpg",
        "p2.jpg",
        "p3.jpg",
    ]


def test_moving_is_by_hand_and_as_uncertain_as_said():
    moved = replay(WALK, [Move("p2.jpg", 1.0, 2.0, 0.5, position_sd=0.01)], prior=PRIOR)[2]
    assert moved.source == "hand"
    np.testing.assert_allclose(moved.planar, [1.0, 2.0, 0.5])
    assert moved.pose.planar_covariance[0, 0] == pytest.approx(1e-4)
    assert moved.t == WALK[2].t


def test_a_robot_is_moved_into_a_photograph_without_one():
    added = replay(
        WALK, [Move("p9.jpg", 1.0, 2.0, 0.5)], prior=PRIOR, times={"p9.jpg": (18.0, 0.1)}
    )[-1]
    assert (added.photo, added.t, added.t_sd) == ("p9.jpg", 18.0, 0.1)


@pytest.mark.parametrize(
    ("correction", "message"),
    [
        (Flip("p1.jpgg"), "p1.jpgg.*did you mean 'p1.jpg'"),
        (Delete("x"), "'x'"),
        (Move("q.jpg", 0, 0, 0), r"q\.jpg"),
    ],
)
def test_a_correction_of_nothing_is_named(correction, message):
    with pytest.raises(CorrectionError, match=message):
        replay(WALK, [correction], prior=PRIOR)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"kind": "turn", "photo": "a"}, "'turn' is missing or unknown"),
        ({"kind": "flip", "phto": "a"}, "did you mean 'photo'"),
        ({"kind": "move", "photo": "a", "y": 1}, "needs x, yaw"),
        ({"kind": "order", "photos": ["a"]}, "'order' is missing or unknown"),
        ({"kind": "flip", "photo": 3}, "photo of correction 'flip' is 3; expected a name"),
        ({"kind": "move", "photo": "a", "x": "b"}, "x of .* is 'b'; expected a finite number"),
        ({"kind": "move", "photo": "a", "x": float("nan")}, "is nan; expected a finite number"),
        ({"kind": "move", "photo": "a", "position_sd": -1}, "is -1; expected a number above 0"),
    ],
)
def test_a_faulty_entry_is_named(entry, message):
    with pytest.raises(CorrectionError, match=message):
        correction_from(entry)


def test_a_flip_turns_what_belongs_to_the_body():
    rng = np.random.default_rng(4)
    root, by = rng.normal(size=(6, 6)), rng.normal(size=(6, 2))
    state = np.array([1.0, 2.0, 0.06, 0.01, -0.02, 0.3])
    pose = BodyPose(state, root @ root.T, {LENS: by, PLACE: by})
    seen = PoseObservation("p0.jpg", 0.0, 0.0, pose, 1.0, "marker")
    (once,) = replay([seen], [Flip("p0.jpg")], prior=PRIOR)
    np.testing.assert_allclose(once.pose.state, [1, 2, 0.06, -0.01, 0.02, 0.3 - np.pi])
    np.testing.assert_allclose(once.pose.by_cause[LENS][:2], by[:2])
    np.testing.assert_allclose(once.pose.by_cause[PLACE][:2], -by[:2])
    assert once.pose.covariance[0, 3] == -pose.covariance[0, 3]
    (twice,) = replay([once], [Flip("p0.jpg")], prior=PRIOR)
    np.testing.assert_allclose(twice.pose.covariance, pose.covariance)
    np.testing.assert_allclose(twice.pose.by_cause[PLACE], by)
