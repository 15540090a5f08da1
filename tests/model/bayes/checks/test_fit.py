# SPDX-License-Identifier: MIT
"""Checks of the model against the data say when data are too thin to make them."""

import numpy as np
import pytest

from model.bayes.advice import MeasureAlso
from model.bayes.checks.check import Outcome
from model.bayes.checks.fit import lag_one_limit, shape, whiteness
from support.judged_fits import blocks_at, clean, two_sided

SLIPS = np.geomspace(0.01, 0.8, 8)


def test_the_limit_of_correlation_widens_with_fewer_pairs():
    assert lag_one_limit(100_000) == 0.05
    assert lag_one_limit(100) == pytest.approx(0.26)


@pytest.mark.parametrize(("per_run", "made"), [(2, False), (5, False), (6, True)])
def test_noise_in_time_needs_enough_pairs_of_blocks(per_run, made):
    blocks = blocks_at(SLIPS[:4], per_run=per_run, loads=(6.0, 12.0))
    check = whiteness(clean(), blocks)
    assert (check.outcome is Outcome.PASSED) == made


def test_the_shape_is_tested_only_where_set_points_are_repeated():
    twice = two_sided(0.4)
    once = twice.select_runs(np.arange(twice.n_runs) // 12 % 2 == 0)
    assert shape(clean(), twice).passed
    check = shape(clean(), once)
    assert check.untested == "repeatability (no slip and load in two runs)"
    assert check.advice == MeasureAlso("no set-point was measured twice", repeats=2)


def test_a_misfit_is_found_even_where_nothing_was_repeated():
    twice = two_sided(0.4)
    once = twice.select_runs(np.arange(twice.n_runs) // 12 % 2 == 0)
    assert shape(clean(misfit=0.2, misfit_p=1e-6), once).failed
