# SPDX-License-Identifier: MIT
"""Observations become a path in order of time, with all of the error and no more samples."""

import numpy as np
import pytest

from tracking.constant_twist import Process
from tracking.errors import PathError
from tracking.path import TRACK_COLUMNS, PoseObservation, assemble_track
from tracking.pose import BodyPose, BodyPrior
from tracking.shared import HEIGHT, SharedErrors

PROCESS = Process(1e-5, 1e-4)


PRIOR = BodyPrior(0.1)
NO_ERRORS = SharedErrors.none()
SHIFT = np.eye(6)[:, [0, 1, 5]]
"""Derivative of a pose by an error that moves and turns it as a whole."""


def walk(times):
    cov = np.diag([1e-6, 1e-6, 1e-7, 1e-7, 1e-7, 1e-5])
    return [
        PoseObservation(
            f"p{k}.jpg", t, 0.0,
            BodyPose(np.array([0.1 * t, 0.0, 0.1, 0.0, 0.0, 0.01 * t]), cov, {"frame": SHIFT}),
            0.9, "marker",
        )
        for k, t in enumerate(times)
    ]  # fmt: skip


def assembled(seen, shared=NO_ERRORS):
    return assemble_track(seen, shared=shared, prior=PRIOR, process=PROCESS)


def test_the_order_given_does_not_matter():
    seen = walk([0, 2, 4, 6])
    forward = assembled(seen)
    backward = assembled(seen[::-1])
    np.testing.assert_allclose(forward.poses, backward.poses)
    assert [o.photo for o in backward.observations] == [f"p{k}.jpg" for k in range(4)]


def test_the_cameras_error_is_not_averaged_away():
    shared = NO_ERRORS.also("frame", 4e-6 * np.eye(3))
    sure, unsure = (assembled(walk(np.arange(60.0)), errors) for errors in (NO_ERRORS, shared))
    difference = unsure.covariance - sure.covariance
    np.testing.assert_allclose(difference, np.tile(4e-6 * np.eye(3), (60, 1, 1)), atol=1e-9)
    # It is common to all poses: the first and the last differ as if there were none.
    between = np.concatenate((np.eye(3), np.zeros((3, 174)), -np.eye(3)), axis=1)
    apart = [between @ track.joint.dense @ between.T for track in (sure, unsure)]
    np.testing.assert_allclose(apart[0], apart[1], rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(unsure.covariance_given(["frame"]), sure.covariance, atol=1e-12)


def test_heights_in_photographs_tell_the_mean_height():
    """Each photograph shows the body 4 mm higher than told, to 1 mm; bounce is 3 mm."""
    prior, shared = BodyPrior(0.1, mean_height_sd=5e-3), NO_ERRORS.also(HEIGHT, 25e-6 * np.eye(1))
    seen = []
    for k in range(50):
        weight = np.array([1e-6, 9e-6]) ** -1.0  # of the photograph, and of the prior
        z = (weight[0] * 0.104 + weight[1] * 0.1) / weight.sum()
        cov = np.diag([1e-6, 1e-6, 1 / weight.sum(), 4e-4, 4e-4, 1e-6])
        cov[0, 2] = cov[2, 0] = cov[2, 2]  # a body that is higher is farther ahead by as much
        cov[0, 0] += cov[2, 2]
        pose = BodyPose(np.array([0.1 * k - 0.1 + z, 0.0, z, 0.0, 0.0, 0.0]), cov)
        seen.append(PoseObservation(f"p{k}", float(k), 0.0, pose, 1.0, "marker"))
    track = assemble_track(seen, shared=shared, prior=prior, process=PROCESS)
    found = track.shared.covariance[0, 0]
    assert found == pytest.approx(1 / (1 / 25e-6 + 50 / 10e-6), rel=1e-3)
    # With the mean height known to be 4 mm more, each pose is 4 mm farther ahead.
    np.testing.assert_allclose(track.poses[:, 0], 0.1 * np.arange(50) + 0.004, atol=1e-4)


def test_the_table_has_the_columns_of_a_track_and_one_row_a_photograph():
    track = assembled(walk([0, 2, 4, 40, 42]))
    assert tuple(track.columns) == TRACK_COLUMNS
    assert {len(column) for column in track.columns.values()} == {5}
    assert np.flatnonzero(track.gap_before).tolist() == [3]
    assert track.columns["cov_xyaw"] == pytest.approx(track.covariance[:, 0, 2])


def test_nothing_seen_and_one_time_twice_are_refused():
    with pytest.raises(PathError, match="no photograph"):
        assembled([])
    with pytest.raises(PathError, match="must increase"):
        assembled(walk([0, 2, 2]))
