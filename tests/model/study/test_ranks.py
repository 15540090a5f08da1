# SPDX-License-Identifier: MIT
"""Ranks say whether a fit is right, and what is wrong with it in words."""

import numpy as np
import pytest

from model.errors import FitError
from model.study.ranks import (
    WRONG,
    RankReplicate,
    RankStudy,
    Replicate,
    conclude_ranks,
    rank_replicate,
    uniformity,
)
from support.study_layouts import design


def replicates(ranks, reliable=True):
    return [RankReplicate(i, {}, {"a": int(r)}, 0.3, 900.0, reliable) for i, r in enumerate(ranks)]


def test_a_replicate_depends_on_seed_and_number_alone():
    study = RankStudy(design(), design())
    once, again = (rank_replicate(study, Replicate(3, 7)) for _ in range(2))
    assert once == again
    assert once.reliable
    assert set(once.ranks) == set(study.fitted.free)
    assert all(0 <= rank <= 99 for rank in once.ranks.values())


def test_a_fit_that_fails_is_told_and_not_dropped(monkeypatch):
    def fail(*_):
        raise FitError("no curve")

    monkeypatch.setattr("model.study.ranks.fit_blocks", fail)
    failed = rank_replicate(RankStudy(design(), design()), Replicate(3, 7))
    assert (failed.failure, failed.reliable, failed.ranks) == ("no curve", False, {})
    result = conclude_ranks(["a"], [*replicates(np.arange(99)), failed])
    assert (result.ranked, result.left_out) == (99, 1)


@pytest.mark.parametrize(
    ("ranks", "words"),
    [
        (np.arange(200) % 100, "uniform"),
        (np.repeat([0, 99], 60), "intervals too narrow"),
        (np.arange(30, 70).repeat(4), "intervals too wide"),
        (np.arange(50).repeat(4), "estimates too high"),
        (np.arange(50, 100).repeat(4), "estimates too low"),
        (np.array([12, 37, 62, 87]).repeat(60), "not uniform"),
        (np.arange(50) * 2, "too few to say"),
    ],
)
def test_ranks_are_put_in_words(ranks, words):
    assert uniformity("a", ranks, parameters=10).words == words


def test_few_ranks_fail_by_the_exact_test_alone():
    assert uniformity("a", np.array([7, 7, 8]), parameters=10).passed
    assert not uniformity("a", np.array([0, 99] * 10), parameters=10).passed


def test_uniform_ranks_pass_and_others_fail_by_name():
    assert conclude_ranks(["a"], replicates(np.arange(100))).headline.startswith("passed: ranks")
    failed = conclude_ranks(["a"], replicates(np.repeat([0, 99], 60)))
    assert failed.headline == "failed: a (intervals too narrow)"


def test_too_few_ranks_or_too_many_left_out_prove_nothing():
    few = conclude_ranks(["a"], replicates(np.arange(0, 100, 2)))
    assert few.headline.startswith("not testable with 50 ranked fits")
    lost = [*replicates(np.arange(100)), *replicates(np.arange(20), reliable=False)]
    assert conclude_ranks(["a"], lost).headline.startswith("not testable: 20 of 120 fits")


def test_no_fit_at_all_is_not_testable():
    result = conclude_ranks(["a"], replicates([1, 2], reliable=False))
    assert result.tests == ()
    assert "0 ranked fits" in result.headline


def test_wrong_models_know_parameters_of_the_measurement():
    free = set(design().free)
    for known in WRONG.values():
        assert set(known) < free
