# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.gait.buehler import buehler_reference
from model.gait.resolution import SEEN, find_noise, find_step

GAIT = buehler_reference(-0.6, 0.7, ground_time=1.02, cycle_time=2.0)
ODD = buehler_reference(-0.63, 0.71, ground_time=0.993, cycle_time=1.931)


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


@pytest.mark.parametrize("cycle", [1.0, 4.0, 8.0])
def test_angles_that_are_held_between_new_ones_are_not_noise(cycle):
    t = np.arange(0, 12, 0.01)
    gait = buehler_reference(-0.6, 0.7, ground_time=0.5 * cycle, cycle_time=cycle)
    assert np.isnan(find_noise(t, gait.angles(np.floor(30 * t + 1e-9) / 30))).all()


def test_only_counts_may_have_noise_of_more_than_a_degree():
    t = np.arange(0, 12, 0.01)
    noisy = GAIT.angles(t) + np.random.default_rng(4).normal(0, np.radians(1.5), (len(t), 6))
    assert np.isnan(find_noise(t, noisy)).all()
    np.testing.assert_allclose(find_noise(t, noisy, np.radians(3.6)), np.radians(1.5), rtol=0.3)


def test_each_leg_has_its_own_noise_and_a_little_is_not_seen():
    rng = np.random.default_rng(3)
    t = np.arange(0, 12, 0.01)
    sd = np.array([0.2, 0.5, 1.0, 2.0, 4.0, 8.0]) * 1e-3
    theta = GAIT.angles(t) + sd * rng.standard_normal((len(t), 6))
    np.testing.assert_allclose(find_noise(t, theta), sd, rtol=0.3)
    assert find_noise(t, GAIT.angles(t) + 0.5 * SEEN * rng.standard_normal((len(t), 6))) is None
    assert find_noise(t[:16], theta[:16]) is None


def test_counting_is_found_and_its_absence_too():
    t, step = np.arange(0, 10, 0.01), np.radians(3.6)
    theta = GAIT.angles(t)
    counted = step * np.round(theta / step)
    assert find_step(counted) == pytest.approx(step, rel=1e-9)
    assert find_step(np.round(counted, 4)) == pytest.approx(step, rel=1e-2)
    assert find_step(theta) is None
    assert find_step(theta + np.random.default_rng(1).normal(0, 1e-3, (len(t), 6))) is None
    assert find_step(np.zeros((100, 6))) is None


@pytest.mark.parametrize("turn", [100, 360, 1000, 1020, 1024, 1030, 1500, 4096, 8192, 16384])
@pytest.mark.parametrize("rate", [50, 100, 1000])
def test_steps_are_found_that_a_leg_takes_many_of_between_two_samples(turn, rate):
    t = np.arange(0, 10, 1 / rate)
    step, theta = 2 * np.pi / turn, ODD.angles(t)
    assert find_step(step * np.round(theta / step)) == pytest.approx(step, rel=1e-4)
    assert find_step(np.round(step * np.round(theta / step), 5)) == pytest.approx(step, rel=1e-2)


@pytest.mark.parametrize("decimals", [4, 15])
@pytest.mark.parametrize(("cycle", "rate"), [(2.0, 100), (3.0, 50), (1.0, 200), (1.0, 10)])
def test_speeds_that_are_multiples_of_each_other_are_no_counts(cycle, rate, decimals):
    gait = buehler_reference(-0.6, 0.7, ground_time=0.6 * cycle, cycle_time=cycle)
    assert find_step(gait.angles(np.arange(0, 12, 1 / rate)).round(decimals)) is None
