# SPDX-License-Identifier: MIT
"""A constant twist fits its own arc; weights and derivatives are those of their definitions."""

import numpy as np
import pytest

from tracking.constant_twist import (
    SWAY_SD,
    SWAY_TIME,
    Process,
    link_derivatives,
    link_error,
    link_weights,
    log_between,
)


def test_a_constant_twist_has_no_error():
    speed, left, turn, dt = 0.2, 0.05, 0.4, np.array([0.7])
    angle = turn * dt[0]
    # The integral of the rotation over the arc: sin and 1 - cos over the turn.
    s, c = np.sin(angle) / turn, (1 - np.cos(angle)) / turn
    a = np.array([[1.0, 2.0, 0.0, speed, left, turn]])
    b = np.array([[1 + s * speed - c * left, 2 + c * speed + s * left, angle, speed, left, turn]])
    np.testing.assert_allclose(link_error(a, b, dt), 0.0, atol=1e-12)
    np.testing.assert_allclose(log_between(a[:, :3], b[:, :3]) / dt, [[speed, left, turn]])


@pytest.mark.parametrize("dt", [0.03, 1.0, 8.0])
def test_weights_are_the_inverse_of_the_covariance_of_white_noise_and_sway(dt):
    process = Process(2e-3, 5e-2)
    weights, log_det = link_weights(np.array([dt, 2 * dt]), process)
    of_time = np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
    covariance = np.kron(of_time, np.diag([process.travel, process.travel, process.turn]))
    covariance[:3, :3] += np.diag(2 * SWAY_SD**2 * min(dt / SWAY_TIME, 1.0))
    np.testing.assert_allclose(weights[0] @ covariance, np.eye(6), atol=1e-3)
    assert log_det == pytest.approx(np.linalg.slogdet(weights)[1].sum(), rel=1e-3)


def test_links_of_an_instant_are_finite_and_hold_to_a_micrometre():
    weights, log_det = link_weights(np.array([1e-12]), Process(1e-4, 1e-3))
    assert np.isfinite(log_det)
    np.testing.assert_allclose(np.linalg.inv(weights[0])[:3, :3], 1e-12 * np.eye(3), rtol=1e-3)


@pytest.mark.parametrize("turn", [0.0, 1e-5, 0.8])
def test_derivatives_are_those_of_differences(turn):
    rng, dt = np.random.default_rng(3), np.array([0.6])
    a, b = rng.normal(size=(1, 6)), rng.normal(size=(1, 6))
    b[0, 2] = a[0, 2] + turn
    by_a, by_b = link_derivatives(a, b, dt)
    for k in range(6):
        h = np.zeros((1, 6))
        h[0, k] = 1e-6
        one = (link_error(a + h, b, dt) - link_error(a - h, b, dt)) / 2e-6
        two = (link_error(a, b + h, dt) - link_error(a, b - h, dt)) / 2e-6
        np.testing.assert_allclose(by_a[0, :, k], one[0], atol=1e-6)
        np.testing.assert_allclose(by_b[0, :, k], two[0], atol=1e-6)
