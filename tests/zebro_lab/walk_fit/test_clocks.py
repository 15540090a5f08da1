# SPDX-License-Identifier: MIT
"""Tracks by another clock than the leg log's: found in the motion, or nothing is invented."""

from pathlib import Path

import numpy as np
import pytest

from model.gait import tripod_angles, tripod_reference
from model.gait.reference import SampledReference
from model.joint_covariance import JointCovariance
from model.poses import Poses
from model.robot import GRAVITY, Robot
from model.walk.ensemble import WalkDraw, planar_walk
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.files.errors import DataError
from zebro_lab.track.file import TrackFile
from zebro_lab.walk_fit.clocks import checked_clock, estimated_clock_of

SLIP = parse_slip("coulomb:0.38")
STOOD, WALKED = 4.0, 16.0
NOISE = 0.002


def legs(*, stands=True):
    """Stand, walk and stand; or walk all the time."""
    t = np.arange(0.0, STOOD + WALKED + STOOD, 0.01)
    walked = np.clip(t - STOOD, 0.0, WALKED) if stands else t
    gait = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
    return SampledReference(t, gait.angles(walked))


def track(walked, *, behind, begin=0.0, end=np.inf):
    """Look at the walk every two seconds by a clock that is behind."""
    robot = Robot()
    law = SLIP.traction_table(weight=robot.mass * GRAVITY)
    path = planar_walk(WalkDraw(robot, walked, law), duration=float(walked.t[-1])).poses
    t = np.arange(max(begin, 0.3), min(end, path.t[-1]), 2.0)
    true = path.at(t)
    noise = np.random.default_rng(1).normal(0.0, NOISE, (len(t), 2))
    covariance = np.tile(np.eye(3) * NOISE**2, (len(t), 1, 1))
    poses = Poses(
        t - behind, true.position + noise, true.yaw, JointCovariance.independent(covariance)
    )
    return TrackFile(poses, "sim:test", Path("t.csv"))


def test_another_clock_is_refused_or_found_where_asked_and_widens_the_covariance():
    walked = legs()
    right, seen = track(walked, behind=0.0), track(walked, behind=3.0)
    assert checked_clock(SLIP)(right, walked, Robot()) is right
    with pytest.raises(DataError, match=r"\+3\.\d ± 0\.\d s behind the leg log's"):
        checked_clock(SLIP)(seen, walked, Robot())
    moved = estimated_clock_of(SLIP)(seen, walked, Robot())
    np.testing.assert_allclose(moved.poses.t, seen.poses.t + 3.0, atol=0.3)
    assert moved.covariance[5, 0, 0] > seen.covariance[5, 0, 0]
    assert "clock" in moved.notes[-1]


def test_an_even_walk_tells_no_offset_and_none_is_invented():
    walked = legs(stands=False)
    seen = track(walked, behind=3.0, begin=6.0, end=20.0)
    assert checked_clock(SLIP)(seen, walked, Robot()) is seen
    with pytest.raises(DataError, match="cannot be estimated"):
        estimated_clock_of(SLIP)(seen, walked, Robot())
