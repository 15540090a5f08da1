# SPDX-License-Identifier: MIT
"""Observations become a path in order of time, with all of the error and no more samples."""

import numpy as np
import pytest

from tracking.errors import PathError
from tracking.path import TRACK_COLUMNS, PoseObservation, assemble_track
from tracking.smooth import Process

PROCESS = Process(1e-5, 1e-4)


def walk(times, shared=1e-6):
    cov = np.diag([1e-6, 1e-6, 1e-5])
    return [
        PoseObservation(f"p{k}.jpg", t, 0.0, np.array([0.1 * t, 0.0, 0.01 * t]), cov,
                    shared * np.eye(3), 0.1, 0.9, "marker")
        for k, t in enumerate(times)
    ]  # fmt: skip


def test_the_order_given_does_not_matter():
    seen = walk([0, 2, 4, 6])
    forward = assemble_track(seen, process=PROCESS)
    backward = assemble_track(seen[::-1], process=PROCESS)
    np.testing.assert_allclose(forward.poses, backward.poses)
    assert [o.photo for o in backward.observations] == [f"p{k}.jpg" for k in range(4)]


def test_the_cameras_error_is_not_averaged_away():
    sure = assemble_track(walk(np.arange(60.0), shared=0.0), process=PROCESS)
    unsure = assemble_track(walk(np.arange(60.0), shared=4e-6), process=PROCESS)
    difference = unsure.covariance - sure.covariance
    np.testing.assert_allclose(difference, np.tile(4e-6 * np.eye(3), (60, 1, 1)), atol=1e-12)


def test_the_table_has_the_columns_of_a_track_and_one_row_a_photograph():
    track = assemble_track(walk([0, 2, 4, 40, 42]), process=PROCESS)
    assert tuple(track.columns) == TRACK_COLUMNS
    assert {len(column) for column in track.columns.values()} == {5}
    assert np.flatnonzero(track.gap_before).tolist() == [3]
    assert track.columns["cov_xyaw"] == pytest.approx(track.covariance[:, 0, 2])


def test_tum_lines_hold_unit_quaternions():
    for line in assemble_track(walk([0, 2, 4]), process=PROCESS).tum:
        numbers = [float(part) for part in line.split()]
        assert len(numbers) == 8
        assert np.linalg.norm(numbers[4:]) == pytest.approx(1, abs=1e-6)


def test_nothing_seen_and_one_time_twice_are_refused():
    with pytest.raises(PathError, match="no photograph"):
        assemble_track([])
    with pytest.raises(PathError, match="must increase"):
        assemble_track(walk([0, 2, 2]))
