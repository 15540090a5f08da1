# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.gait.angle_noise import SEEN, find_noise
from model.gait.buehler import buehler_reference

GAIT = buehler_reference(-0.6, 0.7, ground_time=1.02, cycle_time=2.0)


@pytest.mark.parametrize("rate", [20, 50, 100, 1000])
def test_noise_is_estimated_whatever_the_gait_and_the_rate(rate):
    rng = np.random.default_rng(1)
    t = np.arange(0, 20, 1 / rate)
    for sd in (1e-4, 5e-4, 2e-3):
        theta = GAIT.angles(t) + rng.normal(0, sd, (len(t), 6))
        np.testing.assert_allclose(find_noise(t, theta), sd, rtol=0.3)


@pytest.mark.parametrize("rate", [10, 20, 100, 1000])
def test_corners_and_accelerations_are_no_noise(rate):
    t = np.arange(0, 12, 1 / rate)
    assert find_noise(t, GAIT.angles(t).round(4)) is None
    swung = 1.5 * t[:, None] + 0.3 * np.sin(2 * np.pi * t[:, None] + np.arange(6))
    assert find_noise(t, swung) is None


def test_irregular_times_and_missing_samples_are_no_noise():
    rng = np.random.default_rng(2)
    t = np.sort(rng.uniform(0, 12, 1200))
    t = t[(t < 3) | (t > 4)]
    assert find_noise(t, GAIT.angles(t)) is None
    noisy = GAIT.angles(t) + rng.normal(0, 5e-4, (len(t), 6))
    np.testing.assert_allclose(find_noise(t, noisy), 5e-4, rtol=0.3)


def test_each_leg_has_its_own_noise_and_a_little_is_not_seen():
    rng = np.random.default_rng(3)
    t = np.arange(0, 12, 0.01)
    sd = np.array([0.2, 0.5, 1.0, 2.0, 4.0, 8.0]) * 1e-3
    theta = GAIT.angles(t) + sd * rng.standard_normal((len(t), 6))
    np.testing.assert_allclose(find_noise(t, theta), sd, rtol=0.3)
    assert find_noise(t, GAIT.angles(t) + 0.5 * SEEN * rng.standard_normal((len(t), 6))) is None
    assert find_noise(t[:16], theta[:16]) is None
