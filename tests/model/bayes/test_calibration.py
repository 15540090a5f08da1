# SPDX-License-Identifier: MIT
"""What a calibration says of a fit agrees with the fit's own draws."""

import numpy as np
import pytest

from support.short_calibration import short_calibration


@pytest.fixture(scope="module")
def calibration():
    return short_calibration()


def test_estimates_are_quantiles_of_the_draws(calibration):
    draws = calibration.draws.flat
    for i, estimate in enumerate(calibration.parameters):
        median = np.quantile(draws[:, i], 0.5, method="inverted_cdf")
        assert estimate.median == pytest.approx(median)
        assert estimate.low <= estimate.median <= estimate.high


def test_there_is_a_curve_at_each_load_that_was_set(calibration):
    np.testing.assert_allclose(calibration.levels, [4.0, 12.0], rtol=0.1)
    assert len(calibration.curves) == len(calibration.levels)


def test_data_narrow_the_friction_and_the_law_explains_left_out_samples(calibration):
    assert 0.5 < calibration.contraction["friction"] <= 1.0
    assert 0.5 < calibration.r_squared <= 1.0


def test_a_calibration_keeps_the_source_of_its_data_and_the_time_it_took(calibration):
    assert (calibration.source, calibration.seconds) == ("sim:test", 1.5)
