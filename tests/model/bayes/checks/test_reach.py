# SPDX-License-Identifier: MIT
"""What the data cover: rise, peak, loads, and parameters that data say little of."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import MeasureAlso, MeasureSlips
from model.bayes.checks.reach import reach_of, weak_parameters
from model.slip import Brush
from support.judged_fits import LAW, RIG_VALUES, WELL_INFORMED, blocks_at, draws, two_sided

PEAK = float(LAW.peak_slip(6.0, RIG_VALUES))
VALUES = draws(RIG_VALUES)


def test_a_peak_is_reached_where_slip_passes_nearly_all_of_its_draws():
    for reach in (0.95, 1.05):
        found = reach_of(two_sided(reach * PEAK), LAW, VALUES, {})
        assert found.peak == pytest.approx(reach)
        assert isinstance(found.beyond_the_peak, MeasureSlips)
        assert max(np.abs(found.beyond_the_peak.slips)) > 2 * PEAK
    wide = np.vstack([VALUES, VALUES])
    wide[:1, 0] /= 2.0  # a tenth of the draws have a softer curve, with a later peak
    assert reach_of(two_sided(1.2 * PEAK), LAW, wide, {}).peak < 1
    assert reach_of(two_sided(2.4 * PEAK), LAW, wide, {}).peak > 1


def test_a_law_without_a_peak_has_none_to_reach():
    assert reach_of(two_sided(0.4), Brush(), draws((20.0, 0.38)), {}).peak == np.inf


def test_slips_that_leap_over_the_rise_are_told_what_to_add():
    evenly = np.linspace(0.09, 1.0, 6)
    found = reach_of(blocks_at(np.append(-evenly[::-1], evenly)), LAW, VALUES, {})
    assert found.gap == pytest.approx(1.0)
    assert isinstance(found.on_the_rise, MeasureSlips)
    assert found.on_the_rise.loads == (6.0, 12.0)
    assert 0 < min(found.on_the_rise.slips) < 0.01
    assert reach_of(two_sided(0.4), LAW, VALUES, {}).gap < 0.5


def test_one_load_is_told_apart_and_the_advice_names_two_more():
    assert reach_of(two_sided(0.4), LAW, VALUES, {}).loads == 2
    found = reach_of(two_sided(0.4, loads=(6.0,)), LAW, VALUES, {})
    assert found.loads == 1
    assert isinstance(found.other_loads, MeasureAlso)
    assert found.other_loads.loads == (3.0, 12.0)


def test_what_data_leave_to_the_prior_is_not_measured():
    known = WELL_INFORMED | {"slip_stiffness": 0.3, "curvature": 0.3}
    assert reach_of(two_sided(0.4), LAW, VALUES, known).unmeasured == ("stiffness",)
    assert weak_parameters(two_sided(0.4), LAW, VALUES, known) == ("slip_stiffness", "curvature")


@pytest.mark.parametrize(("reach", "weak"), [(2.4, True), (2.6, False)])
def test_shape_and_friction_are_weak_until_the_curve_has_fallen(reach, weak):
    blocks = two_sided(reach * PEAK)
    for sided in (blocks, replace(blocks, slip=-blocks.slip)):
        found = weak_parameters(sided, LAW, VALUES, WELL_INFORMED)
        assert found == (("shape", "friction") if weak else ())


def test_a_law_without_a_shape_factor_needs_no_reach():
    assert weak_parameters(two_sided(0.1), Brush(), draws((20.0, 0.38)), WELL_INFORMED) == ()
