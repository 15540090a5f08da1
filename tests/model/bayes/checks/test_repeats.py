# SPDX-License-Identifier: MIT
"""Runs repeat one another where they have the same slips at the same load."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.repeats import repeated_share
from support.judged_fits import blocks_at

SLIPS = np.linspace(0.05, 0.8, 8)


def without(blocks, runs):
    return blocks.select_runs(~np.isin(np.arange(blocks.n_runs), runs))


def test_set_points_measured_twice_are_repeated_and_others_are_not():
    twice = blocks_at(SLIPS, loads=(6.0,))
    assert repeated_share(twice) == 1.0
    assert repeated_share(without(twice, np.arange(8))) == 0.0
    assert repeated_share(without(twice, np.arange(4))) == pytest.approx(8 / 12)


def test_the_same_slip_at_another_load_is_no_repeat():
    blocks = without(blocks_at(SLIPS, loads=(6.0, 12.0)), np.r_[0:8, 16:24])
    assert repeated_share(blocks) == 0.0


@pytest.mark.parametrize(("shift", "share"), [(0.0, 1.0), (0.2, 1.0), (0.5, 0.0)])
def test_sweeps_repeat_one_another_where_their_ranges_overlap_by_half(shift, share):
    blocks = blocks_at(np.array([0.1]), loads=(6.0,), per_run=50)
    sweep = np.linspace(0.0, 0.6, 50)
    assert repeated_share(replace(blocks, slip=np.append(sweep, sweep + shift))) == share
