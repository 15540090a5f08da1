# SPDX-License-Identifier: MIT
"""Advice names what a rig can measure."""

import numpy as np
import pytest

from model.bayes.advice import beyond_the_peak, measure_slips
from model.slip.definition import SlipDefinition, convert_slip

LOADS = np.array([5.0, 10.0])
SLIPS = np.array([0.01, 0.03, 0.2])


@pytest.mark.parametrize("definition", SlipDefinition)
def test_slips_to_measure_are_material_whatever_was_fitted(definition):
    slips = convert_slip(SLIPS, SlipDefinition.MATERIAL, definition)
    advice = measure_slips("x", loads=LOADS, slips=slips, definition=definition)
    np.testing.assert_allclose(advice.slips, SLIPS)
    assert advice.loads == (5.0, 10.0)


@pytest.mark.parametrize("definition", SlipDefinition)
def test_a_slip_that_no_rig_can_hold_becomes_the_largest_that_it_can(definition):
    advice = measure_slips("x", loads=LOADS, slips=np.array([-3.0, 3.0]), definition=definition)
    assert min(advice.slips) > -10.1
    assert max(advice.slips) <= 1.0


def test_slips_beyond_the_peak_begin_at_it_and_take_the_side_of_the_data():
    peaks = np.array([0.03, 0.06])
    slips = beyond_the_peak(peaks, np.array([0.001, 0.06]))
    assert slips[0] == pytest.approx(0.03)
    assert slips[-1] == pytest.approx(0.24)
    np.testing.assert_allclose(beyond_the_peak(peaks, np.array([-0.06])), -slips)


def test_without_a_peak_slips_go_on_from_the_largest_tested():
    slips = beyond_the_peak(np.array([np.inf]), np.array([0.01, 0.1]))
    assert slips[0] == pytest.approx(0.1)
    assert slips[-1] == pytest.approx(0.4)
