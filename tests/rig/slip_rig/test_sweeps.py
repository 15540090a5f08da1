# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from scipy.signal import lfilter

from rig.slip_rig.sweeps import sweeps

RATE = 100.0
SPEED = 0.42  # of the leg disc [m/s]


def recorded(slip, *, lag=0.05, noise=0.006, leg=SPEED):
    """Return time and both surface speeds of a rig told to follow slip, as drives tell them."""
    rng = np.random.default_rng(3)
    decay = np.exp(-1 / RATE / lag)
    followed, _ = lfilter([1 - decay], [1, -decay], slip, zi=[decay * slip[0]])
    measured = followed + noise * rng.standard_normal(len(slip))
    return np.arange(len(slip)) / RATE, np.full(len(slip), leg), leg * (1 - measured)


def saw(top, seconds, times):
    return np.tile(np.linspace(0.0, top, round(seconds * RATE)), times)


@pytest.mark.parametrize("seconds", [2.0, 4.0, 16.0])
def test_every_sweep_is_found_and_hardly_anything_is_lost(seconds):
    found = sweeps(*recorded(saw(0.85, seconds, 4)))
    assert found.max() == 3
    assert np.all(np.diff(found[found >= 0]) >= 0)
    assert np.sum(found < 0) <= 3 * 0.4 * RATE
    centre = [np.mean(np.flatnonzero(found == k)) / RATE for k in range(4)]
    np.testing.assert_allclose(centre, seconds * (np.arange(4) + 0.5), atol=0.25)


def test_a_jump_is_left_out_until_slip_has_settled():
    slip = np.repeat([0.8, 0.1], 300)
    t, leg, ground = recorded(slip, noise=0.0)
    found = sweeps(t, leg, ground)
    assert found.max() == 1
    settled = np.abs(1 - ground / leg - slip) < 0.02
    assert np.all(settled[found >= 0])


def test_a_leg_disc_that_stands_has_no_slip():
    t, leg, ground = recorded(np.full(600, 0.2))
    leg[:200] = 0.0
    found = sweeps(t, leg, ground)
    assert np.all(found[:200] == -1)
    assert np.all(found[240:] == 0)
    assert np.all(sweeps(t, np.zeros(600), ground) == -1)


def test_a_disc_that_spins_up_is_left_out():
    t = np.arange(600) / RATE
    leg = SPEED * (1 - np.exp(-t / 0.2))
    ground = SPEED * (1 - np.exp(-t / 0.05))  # the lighter disc is faster: slip begins far below 0
    found = sweeps(t, leg, ground)
    slip = 1 - ground / np.maximum(leg, 1e-9)
    assert np.abs(slip[found >= 0]).max() < 0.1
    assert np.all(found[200:] == 0)


UP = np.linspace(0.0, 0.9, 300)
ONE_SWEEP = {
    "a glide up and down": np.concatenate([UP, UP[::-1], -UP, -UP[::-1]]),
    "stairs": np.repeat(np.linspace(0.0, 0.9, 10), 100),
    "a slip that is held": np.full(2000, 0.3),
    "too short to compare": np.linspace(0.0, 0.8, 20),
}


@pytest.mark.parametrize("slip", ONE_SWEEP.values(), ids=ONE_SWEEP)
@pytest.mark.parametrize("noise", [0.006, 0.02])
def test_slip_without_a_jump_back_is_one_sweep(slip, noise):
    assert np.all(sweeps(*recorded(slip, noise=noise)) == 0)
