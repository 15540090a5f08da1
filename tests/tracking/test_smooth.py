# SPDX-License-Identifier: MIT
"""Smoothing helps where it should, states its error, and invents nothing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.constant_twist import Process
from tracking.errors import PathError
from tracking.smooth import smooth

SD = np.array([2e-3, 2e-3, 5e-3])
COV = np.diag(SD**2)


def wandering(t, process: Process, rng, speed=0.08, turning=0.05):
    """Walk with a twist that white noise disturbs; exact for steps much below dt."""
    fine = 40
    state, twist, out = np.zeros(3), np.array([speed, 0.0, turning]), [np.zeros(3)]
    sd = np.sqrt([process.travel, process.travel, process.turn])
    for dt in np.diff(t):
        for _ in range(fine):
            h = dt / fine
            twist = twist + sd * np.sqrt(h) * rng.standard_normal(3)
            yaw = state[2] + 0.5 * h * twist[2]
            c, s = np.cos(yaw), np.sin(yaw)
            state = state + h * np.array(
                [c * twist[0] - s * twist[1], s * twist[0] + c * twist[1], twist[2]]
            )
        out.append(state)
    return np.array(out)


def arc(t, speed=0.1, turning=0.1):
    yaw = turning * t
    x, y = speed / turning * np.sin(yaw), speed / turning * (1 - np.cos(yaw))
    return np.column_stack((x, y, yaw))


@given(speed=st.floats(0.02, 0.3), turning=st.floats(0.02, 0.4), step=st.floats(0.2, 3.0))
def test_an_arc_is_left_as_it_is(speed, turning, step):
    t = step * np.arange(12)
    truth = arc(t, speed, turning)
    covariance = np.tile(COV, (12, 1, 1))
    path = smooth(t, truth, covariance=covariance, process=Process(1e-6, 1e-6))
    np.testing.assert_allclose(path.poses, truth, atol=1e-6)
    np.testing.assert_allclose(path.twist, np.tile([speed, 0, turning], (12, 1)), atol=1e-5)


def test_smoothing_lowers_the_error_of_a_steady_walk():
    rng, t = np.random.default_rng(0), 0.5 * np.arange(80)
    truth = arc(t)
    measured = truth + SD * rng.standard_normal(truth.shape)
    path = smooth(t, measured, covariance=np.tile(COV, (80, 1, 1)))
    before, after = np.std(measured - truth, axis=0), np.std(path.poses - truth, axis=0)
    assert (after < 0.6 * before).all()


def test_ninety_percent_intervals_cover_ninety_percent():
    rng, z = np.random.default_rng(1), []
    process = Process(2e-5, 2e-4)
    for _ in range(30):
        t = np.cumsum(rng.uniform(0.5, 2.5, 30))
        truth = wandering(t, process, rng)
        measured = truth + SD * rng.standard_normal(truth.shape)
        path = smooth(t, measured, covariance=np.tile(COV, (30, 1, 1)), process=process)
        z.append((path.poses - truth) / np.sqrt(np.diagonal(path.covariance, axis1=1, axis2=2)))
    assert np.abs(np.mean(np.abs(z) < 1.645, axis=(0, 1)) - 0.9).max() < 0.03


def test_the_noise_densities_are_found_to_a_factor_of_a_few():
    rng, t = np.random.default_rng(2), 1.0 * np.arange(150)
    process = Process(2e-5, 2e-4)
    measured = wandering(t, process, rng) + SD * rng.standard_normal((150, 3))
    found = smooth(t, measured, covariance=np.tile(COV, (150, 1, 1))).process
    assert np.abs(np.log10(np.array(found) / process)).max() < 0.6


def test_a_gap_is_flagged_and_nothing_is_put_into_it():
    t = np.array([0, 1, 2, 3, 20, 21, 22, 23.0])
    path = smooth(t, arc(t), covariance=np.tile(COV, (8, 1, 1)))
    assert len(path.poses) == 8
    assert path.segment.tolist() == [0] * 4 + [1] * 4
    assert np.flatnonzero(path.gap_before).tolist() == [4]


def test_yaw_may_wrap():
    t = np.arange(30.0)
    truth = arc(t, turning=0.3)
    wrapped = truth.copy()
    wrapped[:, 2] = np.angle(np.exp(1j * truth[:, 2]))
    path = smooth(t, wrapped, covariance=np.tile(COV, (30, 1, 1)), process=Process(1e-6, 1e-6))
    np.testing.assert_allclose(path.poses[:, 2], truth[:, 2], atol=1e-5)


def test_an_uncertain_time_widens_the_path_along_the_motion_only():
    t = 2.0 * np.arange(10)
    poses = np.column_stack((0.1 * t, np.zeros(10), np.zeros(10)))
    covariance = np.tile(COV, (10, 1, 1))
    process = Process(1e-3, 1e-3)
    sure = smooth(t, poses, covariance=covariance, process=process)
    unsure = smooth(t, poses, covariance=covariance, time_sd=0.3, process=process)
    ratio = unsure.covariance[:, [0, 1], [0, 1]] / sure.covariance[:, [0, 1], [0, 1]]
    assert (ratio[:, 0] > 10).all()
    assert ratio[:, 1] == pytest.approx(1.0, abs=1e-6)


def test_an_outlier_is_suspect():
    t = np.arange(20.0)
    poses = arc(t)
    poses[9, 0] += 0.05
    path = smooth(t, poses, covariance=np.tile(COV, (20, 1, 1)), process=Process(1e-6, 1e-5))
    assert path.suspect[9]


def test_one_pose_is_its_own_path():
    path = smooth([3.0], [[1, 2, 0.5]], covariance=[COV])
    np.testing.assert_allclose(path.poses, [[1, 2, 0.5]])
    np.testing.assert_allclose(path.covariance[0], COV, rtol=1e-6)


def test_times_that_do_not_increase_are_named():
    with pytest.raises(PathError, match="pose 3 is at 1 s"):
        smooth([0, 1, 1], np.zeros((3, 3)), covariance=np.tile(COV, (3, 1, 1)))


@pytest.mark.parametrize("apart", [1e-3, 1e-4, 1e-7])
def test_two_photographs_of_nearly_one_time_are_one_pose_measured_twice(apart):
    t = np.array([0.0, 1.0, 2.0, 2.0 + apart, 3.0, 4.0])
    rng, truth = np.random.default_rng(2), arc(t)
    measured = truth + SD * rng.standard_normal(truth.shape)
    path = smooth(t, measured, covariance=np.tile(COV, (6, 1, 1)), gap=2.0)
    np.testing.assert_allclose(path.poses[2], path.poses[3], atol=0.2 * apart + 2e-5)
    assert np.all(np.abs(path.poses - truth) < 4 * SD)


def test_a_covariance_that_is_none_is_named():
    with pytest.raises(PathError, match="not positive definite"):
        smooth([0, 1, 2], arc(np.arange(3.0)), covariance=np.zeros((3, 3, 3)))
