# SPDX-License-Identifier: MIT
"""Gaps in the tested slips below the peak, and the slips that fill them."""

from dataclasses import replace

import numpy as np
import pytest

from model.arrays import Array
from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.rise import SLIPS, sampled_rise
from model.slip import Brush, MagicFormula
from model.slip.definition import SlipDefinition
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES

LOADS = (5.0, 10.0)
PEAKS = 0.0066 * np.array(LOADS)  # the law of the thesis: the peak's slip grows with load


def blocks_at(slips, *, loads=LOADS) -> SlipBlocks:
    """Make one run of two blocks for each slip at each load."""
    load, slip = (np.repeat(x.ravel(), 2) for x in np.meshgrid(loads, slips, indexing="ij"))
    zeros, n_runs = np.zeros(len(slip)), len(slip) // 2
    return SlipBlocks(
        slip=slip, normal_force=load, traction_force=zeros, count=np.full(len(slip), 50),
        run=np.repeat(np.arange(n_runs), 2), run_names=tuple(map(str, range(n_runs))),
        definition=SlipDefinition.MATERIAL, slip_wander=zeros, slip_error=zeros,
        load_variance=zeros, load_skewness=zeros, slip_load_covariance=zeros,
        run_slip_error=np.zeros(n_runs), load_error=zeros, noise_size=zeros + 1,
    )  # fmt: skip


def draws(*law_values: float) -> Array:
    return np.tile([*law_values, 0.0, 0.0, 0.0, 0.0, 0.02, 0.01, 0.1, 0.05], (5, 1))


THESIS = draws(*THESIS_VALUES)


def rise_of(slips, **changes):
    return sampled_rise(replace(blocks_at(slips), **changes), THESIS_LAW, THESIS)


def test_even_slips_over_the_whole_range_leave_out_the_rise():
    rise = rise_of(np.linspace(0.0, 1.0, 12))
    assert rise.gap == pytest.approx(1.0)


def test_the_widest_gap_counts_and_zero_is_one_of_its_ends():
    assert rise_of(PEAKS[0] * np.array([0.8, 3.0])).gap == pytest.approx(0.4)  # 10 N: 0.4 and 1.5
    assert rise_of(PEAKS[1] * np.array([0.7, 3.0])).gap == pytest.approx(0.7)


def test_loads_help_one_another_because_the_law_joins_them():
    slips = PEAKS[1] * np.array([0.0, 0.4, 1.0])  # at 5 N: 0, 0.8 and beyond
    assert rise_of(slips).gap == pytest.approx(0.4)
    alone = sampled_rise(blocks_at(slips, loads=LOADS[:1]), THESIS_LAW, THESIS)
    assert alone.gap == pytest.approx(0.8)


def test_a_peak_that_no_load_moves_counts_once_for_all_loads():
    law, values = MagicFormula("constant"), draws(20.4, 1.564, 0.38, 0.0)
    peak = float(law.peak_slip(5.0, values[0, :4]))
    rise = sampled_rise(blocks_at([0.4 * peak, 0.7 * peak, 0.9]), law, values)
    assert rise.gap == pytest.approx(0.4)
    assert peak < rise.further[-1] < 1.5 * peak


def test_braking_counts_as_driving_and_is_answered_by_braking():
    slips = PEAKS[1] * np.array([0.1, 0.7, 3.0])
    driving, braking = rise_of(slips), rise_of(-slips)
    assert braking.gap == pytest.approx(driving.gap)
    np.testing.assert_allclose(braking.further, -driving.further)


def test_a_sweep_that_ends_on_the_rise_has_no_gap_behind_its_end():
    assert rise_of(PEAKS[0] * np.linspace(0.0, 0.5, 6)).gap == pytest.approx(0.1)


@pytest.mark.parametrize("loads", [LOADS, (2.13, 12.75), (6.0,)])
def test_the_further_slips_fill_the_gap_that_they_are_for(loads):
    even = np.linspace(0.0, 1.0, 12)
    further = sampled_rise(blocks_at(even, loads=loads), THESIS_LAW, THESIS).further
    assert len(further) == SLIPS
    filled = sampled_rise(blocks_at(np.append(even, further), loads=loads), THESIS_LAW, THESIS)
    assert filled.gap < 0.3
    peaks = 0.0066 * np.array(loads)
    assert 0 < further[0] < 0.2 * peaks.min()
    assert peaks.max() < further[-1] < 1.5 * peaks.max()


def test_an_unsure_peak_is_looked_for_in_all_of_its_interval():
    unsure = np.vstack([draws(20.4, 1.564, 0.38, x) for x in (0.004, 0.0066, 0.012)])
    further = sampled_rise(blocks_at(np.linspace(0, 1, 12)), THESIS_LAW, unsure).further
    assert further[0] < 0.2 * 0.004 * LOADS[0]
    assert further[-1] > 0.012 * LOADS[1]


def test_a_curve_without_a_peak_has_neither_gap_nor_further_slips():
    rise = sampled_rise(blocks_at([0.0, 0.9]), Brush(), draws(20.0, 0.38))
    assert rise.gap == 0.0
    assert len(rise.further) == 0
