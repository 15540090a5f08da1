# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.errors import InsufficientData
from model.joint_covariance import JointCovariance
from model.judgement import PREDICTION, STAND_STILL, Prediction, judge, judge_tilt
from model.poses import Poses
from model.walk.path import WalkPath

T = np.linspace(0.0, 10.0, 101)
SEEN = np.arange(0.5, 9.6, 1.0)
SD = np.array([0.002, 0.002, 0.005])


def walk(speed=0.1, rate=0.05, n=None, spread=0.0, seed=1):
    """Return a walk in a curve, or n draws of it whose speeds differ."""
    rng = np.random.default_rng(seed)
    speeds = np.full(1 if n is None else n, speed)[:, None]
    speeds = speeds * (1 + spread * rng.standard_normal(speeds.shape))
    yaw = np.broadcast_to(rate * T, (len(speeds), len(T)))
    position = np.stack([speeds / rate * np.sin(yaw), speeds / rate * (1 - np.cos(yaw))], axis=-1)
    draws = Poses(T, position, yaw)
    return draws.draws(0) if n is None else draws


def track(speed=0.1, seed=2):
    """Return the walk as seen on a floor whose frame is turned and shifted, with noise."""
    noise = np.random.default_rng(seed).normal(0, SD, (len(SEEN), 3))
    seen = walk(speed).moved(rotation=0.8, translation=[1.0, 2.0]).at(SEEN)
    joint = JointCovariance.independent(np.tile(np.diag(SD**2), (len(SEEN), 1, 1)))
    return Poses(SEEN, seen.position + noise[:, :2], seen.yaw + noise[:, 2], joint)


def judged(prediction, seen=None, *, anchor=True):
    seen = track() if seen is None else seen
    return judge(prediction, seen, anchor=anchor, rng=np.random.default_rng(3))


def test_the_true_path_errs_by_the_tracker_s_noise_and_standing_by_the_walk():
    result = judged(Prediction(walk()))
    by_name = {row.name: row for row in result.rows}
    assert list(by_name) == [PREDICTION, STAND_STILL]
    assert by_name[PREDICTION].errors.ate < 0.02
    assert by_name[STAND_STILL].errors.ate > 0.3
    assert len(result.track) == len(SEEN) - 1
    assert result.band is None


def test_without_anchor_the_frames_stay_apart_and_every_pose_is_scored():
    result = judged(Prediction(walk()), anchor=False)
    assert len(result.track) == len(SEEN)
    assert result.rows[0].errors.ate > 1.0
    assert result.rows[0].errors.ate_aligned < 0.01


def test_a_band_of_the_right_width_holds_its_share():
    shares = []
    for seed in range(20):
        speed = 0.1 * (1 + 0.05 * np.random.default_rng(seed).standard_normal())
        band = walk(n=300, spread=0.05, seed=100 + seed)
        result = judged(Prediction(walk(), band), track(speed, seed=seed))
        shares.append(result.rows[0].scores.coverage[-1].mean())
        assert result.rows[0].consistency
        assert result.band is not None
    assert np.mean(shares) == pytest.approx(0.9, abs=0.08)


def test_what_all_tracked_poses_have_wrong_alike_does_not_widen_a_path_that_starts_from_one():
    shared = np.tile([1.0, 0.0, 0.0], (len(SEEN), 1))
    seen = track()
    aside = replace(seen, joint=seen.joint.also(shared, 0.05**2))
    alone = replace(seen, joint=JointCovariance.independent(aside.covariance))
    band = walk(n=300, spread=0.05)
    plain, common, apart = (
        judged(Prediction(walk(), band), each).rows[0].scores.width[1, 0]
        for each in (seen, aside, alone)
    )
    assert common == pytest.approx(plain, rel=0.05)
    assert apart > 5 * plain


def test_baselines_are_judged_beside_the_prediction():
    result = judged(Prediction(walk(), baselines={"slower": walk(0.05)}))
    assert [row.name for row in result.rows] == [PREDICTION, "slower", STAND_STILL]
    errors = [row.errors.ate for row in result.rows]
    assert errors == sorted(errors)


def test_a_track_of_another_time_cannot_be_judged():
    with pytest.raises(InsufficientData, match="same clock"):
        judged(Prediction(walk()), track().delayed(100.0))


def test_a_track_without_headings_starts_no_path():
    seen = track()
    blind = Poses(seen.t, seen.position, np.full(len(seen), np.nan), seen.joint)
    with pytest.raises(InsufficientData, match="no headings"):
        judged(Prediction(walk()), blind)


def walk_of_tilt():
    """Return a walk that rocks in roll and pitch."""
    orientation = np.column_stack([0.02 * np.sin(T), 0.01 * np.cos(T), 0.0 * T])
    zero, pairs = np.zeros((len(T), 6)), np.zeros((len(T), 6, 2))
    return WalkPath(T, np.zeros((len(T), 3)), orientation, zero, zero > 0, pairs, zero, zero, pairs)


def test_tilt_of_the_same_walk_differs_by_what_was_added():
    rocked = walk_of_tilt()
    t, angles = T[10:60], rocked.orientation[10:60, :2] + [0.01, 0.0]
    told = judge_tilt(rocked, t, angles)
    apart = told.measured - told.predicted
    np.testing.assert_allclose(apart, np.tile([0.01, 0], (50, 1)), atol=1e-9)
    np.testing.assert_allclose(np.abs(told.errors.bias), [0.01, 0.0], atol=1e-9)
