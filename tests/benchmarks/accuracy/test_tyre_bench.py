# SPDX-License-Identifier: MIT
"""What the benchmark of the tyre bench measures itself: scatter of groups, and scipy's fit."""

import numpy as np

from benchmarks.accuracy.tyre_bench import group_means, least_squares_fit
from model.slip.magic_formula import magic_formula

LEVELS = np.array([500.0, 1500.0])


def drawn(seed, offset=0.0):
    """Return mean residuals of blocks of 8 runs at two loads, with scatter of runs and blocks."""
    rng = np.random.default_rng(seed)
    run = np.repeat(np.arange(8), 20)
    slip = np.tile(np.linspace(-0.1, 0.1, 20), 8)
    load = LEVELS[run % 2]
    residual = 5.0 * rng.normal(size=16)[2 * run + (slip > 0)] + 3.0 * rng.normal(size=160)
    return group_means(residual + offset * np.sign(slip), slip, load, run, LEVELS)


def test_means_of_sound_groups_are_as_far_from_zero_as_their_scatter_says():
    found = [drawn(seed) for seed in range(60)]
    scores = np.concatenate([each.mean / each.sd for each in found])
    assert 0.9 < np.std(scores) < 1.25  # the scatter of runs is itself known from 16 means only
    assert np.mean([each.p < 0.01 for each in found]) < 0.06


def test_an_offset_by_side_is_found():
    assert np.mean([drawn(seed, offset=20.0).p < 0.01 for seed in range(20)]) > 0.9


def test_least_squares_finds_shifts_where_they_are_let():
    slip = np.linspace(-0.15, 0.15, 301)
    load = np.where(np.arange(301) % 2, 500.0, 1500.0)
    force = magic_formula(slip - 0.002, 15.0, 1.4, 1.2 * load, -0.2) - 0.03 * load
    plain, shifted = (least_squares_fit(slip, load, force, shifts=s) for s in (False, True))
    assert np.abs(shifted).max() < 0.1
    assert np.sqrt(np.mean(plain**2)) > 10
