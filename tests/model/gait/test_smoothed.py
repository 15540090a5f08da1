# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.gait.smoothed import SmoothedLeg

FAST = 2 * np.pi  # rad/s


def uneven(sd, *, seed=0, gap=False):
    """Return a leg whose speed swings by 80 %, and its true angles."""
    t = np.arange(0, 12, 0.01)
    t = t[(t < 5) | (t > 5.2)] if gap else t
    theta = FAST * t + 0.8 * np.sin(FAST * t)
    return SmoothedLeg(t, theta + np.random.default_rng(seed).normal(0, sd, len(t))), theta


def speeds(theta):
    return (theta[..., 4:] - theta[..., :-4]) / 0.04


@pytest.mark.parametrize("sd", [2e-4, 1e-3, 1e-2])
def test_angles_and_speeds_are_closer_than_the_noisy_ones(sd):
    leg, theta = uneven(sd)
    angle = leg.corners(None)[1]
    assert np.std(angle - theta) < 0.6 * sd
    assert np.std(speeds(angle - theta)) < 0.6 * np.std(speeds(leg.theta - theta))
    assert leg.fit.noise == pytest.approx(sd, rel=0.1)


@pytest.mark.parametrize("sd", [2e-4, 1e-3, 1e-2])
def test_draws_hold_angles_and_speeds_as_often_as_they_say(sd):
    leg, theta = uneven(sd, gap=True)
    rng = np.random.default_rng(1)
    draws = np.stack([leg.corners(rng)[1] for _ in range(100)])
    low, high = np.quantile(draws, [0.05, 0.95], axis=0)
    assert 0.83 < np.mean((low < theta) & (theta < high)) < 0.96
    low, high = np.quantile(speeds(draws), [0.05, 0.95], axis=0)
    assert 0.85 < np.mean((low < speeds(theta)) & (speeds(theta) < high)) < 0.99


def test_the_smooth_angles_are_those_of_the_equation():
    t = np.array([0.0, 0.1, 0.15, 0.3, 0.4, 0.41, 0.6])
    leg = SmoothedLeg(t, np.array([0.0, 0.2, 0.1, 0.5, 0.9, 0.7, 1.0]))
    apart = np.diff(t) / np.diff(t).mean()
    turn = np.diff(np.diff(np.eye(len(t)), axis=0) / apart[:, None], axis=0)
    penalty = turn.T @ (turn / (0.5 * (apart[1:] + apart[:-1]))[:, None])
    expected = np.linalg.solve(np.eye(len(t)) + leg.fit.stiffness * penalty, leg.theta)
    np.testing.assert_allclose(leg.fit.angle, expected, atol=1e-6)


def test_a_straight_line_stays_one():
    t = np.sort(np.random.default_rng(2).uniform(0, 5, 300))
    np.testing.assert_allclose(SmoothedLeg(t, 3.0 - 2.0 * t).fit.angle, 3.0 - 2.0 * t, atol=1e-6)


def test_samples_that_arrive_together_are_smoothed_like_others():
    leg, theta = uneven(1e-3)
    late = np.arange(0, len(leg.t) - 1, 7)
    t = leg.t.copy()
    t[late] = t[late + 1] - 1e-7
    theta = FAST * t + 0.8 * np.sin(FAST * t)
    noisy = theta + np.random.default_rng(3).normal(0, 1e-3, len(t))
    angle = SmoothedLeg(t, noisy).corners(None)[1]
    assert np.std(angle - theta) < 0.6e-3
