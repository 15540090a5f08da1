# SPDX-License-Identifier: MIT
"""The plain fit finds the curve that the data are made of, whatever form they have."""

import numpy as np
import pytest

from model.bayes.averaging.blocks import block_means
from support.plain_samples import TRUTH, fitted_plainly, set_points, sweeps


@pytest.mark.parametrize("make", [set_points, sweeps])
@pytest.mark.parametrize("wrong", [{}, {"zero": 0.008, "offset": 0.05}])
def test_the_curve_is_found_with_the_zeros_of_force_and_slip(make, wrong):
    found = fitted_plainly(make(**wrong))
    assert found.values[[0, 2]] == pytest.approx(TRUTH[[0, 2]], rel=0.02)
    assert found.zero == pytest.approx(wrong.get("zero", 0.0), abs=5e-4)
    assert found.offset == pytest.approx(wrong.get("offset", 0.0), abs=0.01)


def test_resampled_fits_scatter_as_fits_of_other_data_do():
    draws = fitted_plainly(set_points(noise=0.0, a_run=0.05)).draws
    others = [
        fitted_plainly(set_points(noise=0.0, a_run=0.05, seed=seed)).values for seed in range(12)
    ]
    assert np.std(draws[:, 0]) == pytest.approx(np.std(others, axis=0)[0], rel=0.7)


def test_averages_that_bend_the_curve_move_the_fit_and_short_ones_do_not():
    samples = sweeps(samples=600)
    found = fitted_plainly(samples)
    long, short = (
        found.moved_by_averaging(samples.slip, block_means(samples, length)) for length in (60, 2)
    )
    assert long > 1.0
    assert short < 0.2


def test_a_description_has_the_curve_its_intervals_and_what_was_fitted():
    text = fitted_plainly(set_points()).describe()
    assert "24 means of runs" in text
    assert text.count("…") == 2
    assert "slope at zero slip 79.9" in text  # K 20 at the median load of 4 N
