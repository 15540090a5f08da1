# SPDX-License-Identifier: MIT
import numpy as np

from benchmarks.accuracy.lab_walks import EVERY, NOISE, STEP, Bench


def test_a_walk_has_counted_legs_and_a_track_with_noise(one_walk, calibration, tmp_path):
    bench = Bench(calibration, tmp_path / "scratch")
    walk, truth = bench.walk(one_walk), bench.engine[one_walk].truth
    counts = walk.legs.theta / STEP
    assert np.allclose(counts, np.round(counts))
    assert np.allclose(np.diff(walk.track.poses.t), EVERY)
    away = walk.track.poses.position[:, 0] - np.interp(walk.track.poses.t, truth["t"], truth["x"])
    assert 0 < np.abs(away).max() < 5 * NOISE[0]


def test_leg_angles_that_are_not_counted_are_the_engine_s(one_walk, calibration, tmp_path):
    bench = Bench(calibration, tmp_path / "scratch", counted=False)
    np.testing.assert_allclose(bench.walk(one_walk).legs.theta, bench.engine[one_walk].log.theta)
