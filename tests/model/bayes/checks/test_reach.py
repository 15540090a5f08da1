# SPDX-License-Identifier: MIT
"""What the data cover: the peak, several loads, parameters that data say little of."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import MeasureAlso, MeasureSlips
from model.bayes.checks.reach import loads, peak, slip_reach, weak_parameters
from model.slip import Brush
from support.judged_fits import LAW, RIG_VALUES, WELL_INFORMED, draws, two_sided

PEAK = float(LAW.peak_slip(6.0, RIG_VALUES))
VALUES = draws(RIG_VALUES)


@pytest.mark.parametrize(("reach", "tested"), [(0.95, False), (1.05, True)])
def test_a_peak_beyond_the_tested_slips_is_an_extrapolation(reach, tested):
    check = peak(two_sided(reach * PEAK), LAW, VALUES)
    assert check.passed == tested
    assert check.untested == ("" if tested else "peak (slip ends before it)")
    if not tested:
        assert isinstance(check.advice, MeasureSlips)
        assert max(np.abs(check.advice.slips)) > 2 * PEAK


def test_a_peak_that_may_lie_further_out_is_none_that_was_tested():
    wide = np.vstack([VALUES, VALUES])
    wide[:1, 0] /= 2.0  # a tenth of the draws have a softer curve, with a later peak
    assert not peak(two_sided(1.2 * PEAK), LAW, wide).passed
    assert peak(two_sided(2.4 * PEAK), LAW, wide).passed


def test_a_law_without_a_peak_has_none_to_test():
    assert peak(two_sided(0.4), Brush(), draws((20.0, 0.38))).passed


def test_one_load_says_nothing_of_others_and_the_advice_names_two_more():
    assert loads(two_sided(0.4)).passed
    check = loads(two_sided(0.4, loads=(6.0,)))
    assert check.untested == "dependence on load (one load: it is the prior's)"
    assert isinstance(check.advice, MeasureAlso)
    assert check.advice.loads == (3.0, 12.0)


@pytest.mark.parametrize(("reach", "weak"), [(2.4, True), (2.6, False)])
def test_shape_and_friction_are_weak_until_the_curve_has_fallen(reach, weak):
    blocks = two_sided(reach * PEAK)
    for sided in (blocks, replace(blocks, slip=-blocks.slip)):
        assert slip_reach(sided, LAW, VALUES) == pytest.approx(reach)
    assert ("shape" in weak_parameters(blocks, LAW, VALUES, WELL_INFORMED)) == weak
