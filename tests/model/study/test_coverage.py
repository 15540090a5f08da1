# SPDX-License-Identifier: MIT
"""Counts of intervals are compared with exact binomial bands."""

import numpy as np
import pytest
from scipy.stats import binom

from model.errors import FitError
from model.study import weighted_fit
from model.study.coverage import (
    RIG,
    CoverageReplicate,
    CoverageStudy,
    binomial_band,
    conclude_coverage,
    coverage_replicate,
)
from model.study.ranks import Replicate
from support.study_layouts import design

TRUE = {"slip_stiffness": 20.0, "friction": 0.4, "noise_floor": 0.05, "noise_slope": 0.02,
        "noise_correlation": 0.3, "offset_spread": 0.05}  # fmt: skip


def replicates(half, ninety, n=100, reliable=True):
    """Return replicates of which the first `half` and `ninety` hold."""
    return [
        CoverageReplicate(
            i, {"a": 1.0}, {"a": (i < half, i < ninety)}, {"a": 0.1}, {"a": 2.0}, 0.2, 900.0,
            reliable,
        )
        for i in range(n)
    ]  # fmt: skip


@pytest.mark.parametrize(("n", "share"), [(20, 0.5), (100, 0.9), (300, 0.9)])
def test_the_band_is_the_exact_binomial_one(n, share):
    assert binomial_band(n, share, 0.01) == tuple(map(int, binom.interval(0.99, n, share)))


def test_a_replicate_compares_every_parameter_with_its_truth(monkeypatch):
    monkeypatch.setattr(weighted_fit, "ENOUGH", 400.0)
    monkeypatch.setattr("model.bayes.weighted.FURTHER_DRAWS", 500)
    study = CoverageStudy(design(), TRUE)
    found = coverage_replicate(study, Replicate(2, 5))
    assert found == coverage_replicate(study, Replicate(2, 5))
    assert found.reliable
    assert set(found.held) == {*TRUE, *RIG, "slip_scatter"}  # these slips have no error to scale
    assert found.truth["friction"] == 0.4
    assert found.truth["gain_normal"] != 0
    assert all(half > 0 for half in found.half.values())


def test_a_fit_that_fails_is_told(monkeypatch):
    def fail(*_):
        raise FitError("no curve")

    monkeypatch.setattr("model.study.coverage.fit_blocks", fail)
    failed = coverage_replicate(CoverageStudy(design(), TRUE), Replicate(2, 5))
    assert failed.failure == "no curve"
    assert conclude_coverage([failed]).covered == ()


@pytest.mark.parametrize(
    ("half", "ninety", "words"),
    [
        (50, 90, "as stated"),
        (50, 60, "intervals too narrow, or off"),
        (80, 100, "more often than stated"),
        (50, 81, "as stated, within the chance of all counts together"),
    ],
)
def test_counts_are_put_in_words(half, ninety, words):
    (covered,) = conclude_coverage(replicates(half, ninety)).covered
    assert covered.words == words


def test_the_headline_names_what_fails_and_what_is_too_little():
    assert conclude_coverage(replicates(50, 90)).headline.startswith("passed: intervals of all 1")
    assert conclude_coverage(replicates(50, 50)).headline.startswith("failed: a (intervals too n")
    few = conclude_coverage(replicates(5, 9, n=10))
    assert few.headline.startswith("not testable with 10 fits")
    lost = [*replicates(50, 90), *replicates(5, 9, n=30, reliable=False)]
    assert conclude_coverage(lost).headline.startswith("not testable: 30 of 130")


def test_intervals_that_hold_more_often_than_stated_do_not_fail():
    assert conclude_coverage(replicates(100, 100)).headline.startswith("passed")


def test_few_intervals_say_little():
    (covered,) = conclude_coverage(replicates(5, 9, n=10)).covered
    assert covered.words == "too few to say"


def test_means_of_error_and_half_width_are_those_of_the_fits_that_count():
    (covered,) = conclude_coverage(replicates(50, 90)).covered
    assert (covered.n, covered.truth) == (100, 1.0)
    assert np.allclose([covered.bias, covered.half], [0.1, 2.0])
