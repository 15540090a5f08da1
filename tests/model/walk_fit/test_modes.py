# SPDX-License-Identifier: MIT
"""The search for modes on a problem that is linear, where every answer is known."""

import numpy as np
import pytest

from model.robot import N_LEGS
from model.walk_fit.modes import ModeSearch
from model.walk_fit.prior import ACROSS, WRONG, WalkPrior, WrongLeg

K = 40


class LinearMisfit:
    """Residuals that are linear in the leg offsets, with a true offset of each leg [rad]."""

    size = K

    def __init__(self, offset):
        self.A = np.random.default_rng(4).standard_normal((K, N_LEGS)) / np.radians(0.3)
        self.offset = np.asarray(offset)

    def tasks(self, _state):
        return []

    def joined(self, _walked):
        return None

    def residuals(self, legs, _walked):
        return (legs.offset - self.offset) @ self.A.T


def search(offset):
    return ModeSearch([LinearMisfit(offset)], WalkPrior())


def test_a_climb_ends_where_the_gradient_is_zero():
    found = search(np.radians([0.3, -0.2, 0.1, 0.0, 0.2, 0.0]))
    mode, J = found.climb(None, np.zeros(WRONG + 1))
    gradient = J.T @ found.residuals(mode.z[None], None)[0] + mode.z
    assert np.abs(gradient).max() < 0.5
    assert found.cost(mode.z, None) < found.cost(np.zeros(WRONG + 1), None)
    expected = np.linalg.inv(J.T @ J + np.eye(WRONG + 1))
    np.testing.assert_allclose(mode.covariance, expected)


def test_the_leg_that_is_wrong_is_the_likeliest_case():
    offset = np.zeros(N_LEGS)
    offset[3] = np.radians(6.0)
    told = []
    modes = search(offset).modes(progress=told.append)
    best = max(modes, key=lambda mode: mode.log_evidence)
    assert best.case == WrongLeg(3)
    assert best.z[WRONG] * WalkPrior().wrong_sd == pytest.approx(np.radians(6.0), rel=0.1)
    assert told == sorted(told)


def test_legs_as_described_are_likeliest_without_a_wrong_one():
    modes = search(np.zeros(N_LEGS)).modes(progress=lambda _: None)
    assert max(modes, key=lambda mode: mode.log_evidence).case is None


def test_parameters_that_are_held_end_at_the_middle_of_their_prior():
    offset = np.radians([0.3, -0.2, 0.1, 0.0, 0.2, 0.0])
    held = ModeSearch([LinearMisfit(offset)], WalkPrior(), held=[0, *ACROSS])
    mode, J = held.climb(None, np.ones(WRONG + 1))
    assert not J[:, [0, *ACROSS]].any()
    np.testing.assert_allclose(mode.z[[0, *ACROSS]], 0.0, atol=1e-12)
    assert abs(mode.z[1]) > 0.1


def test_a_prior_without_lateral_spread_holds_lateral_traction():
    alike = ModeSearch([LinearMisfit(np.zeros(6))], WalkPrior(lateral_sd=0.0))
    mode, J = alike.climb(None, np.zeros(WRONG + 1))
    assert not J[:, ACROSS].any()
    np.testing.assert_array_equal(mode.z[ACROSS], 0.0)
