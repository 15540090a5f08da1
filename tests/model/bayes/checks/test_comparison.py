# SPDX-License-Identifier: MIT
"""Plain fit and posterior agree on sound data, and not where something spoilt the posterior."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.comparison import Comparison, compare_plain
from model.bayes.plain.fit import plain_fit
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from support.linearised_fits import EXACT, linearised, only, swept, unchanged


def compared(change=unchanged, **found):
    """Compare the plain fit with a posterior that found the true curve but for some values."""
    posterior, fit, samples = linearised(change, found={**EXACT, **found})
    priors = {p.name: posterior.priors[p.name] for p in THESIS_LAW.parameters}
    plain = plain_fit(
        samples, THESIS_LAW, priors=priors, zero_sd=0.003, rng=np.random.default_rng(1)
    )
    return compare_plain(posterior, fit, plain, np.random.default_rng(2))


@pytest.mark.parametrize("change", [unchanged, swept()], ids=["means of runs", "rows of sweeps"])
def test_sound_data_agree(change):
    found = compared(change)
    assert found is not None
    assert found.distance < 1


@pytest.mark.parametrize(("name", "feature"), [("slip_stiffness", "slope"), ("friction", "force")])
def test_a_posterior_that_a_wrong_prior_spoilt_does_not_agree(name, feature):
    k = [p.name for p in THESIS_LAW.parameters].index(name)
    found = compared(**{name: 0.75 * float(THESIS_VALUES[k])})
    assert found is not None
    assert not found.agree
    assert getattr(found, feature) == pytest.approx(1 / 3, abs=0.15)


def test_one_run_shows_no_scatter():
    assert compared(lambda s: only(swept()(s), np.arange(1))) is None


def test_a_difference_must_be_both_beyond_chance_and_large():
    differs = Comparison(slope=0.06, force=0.0, distance=1.2)
    assert not differs.agree
    assert replace(differs, distance=0.9).agree
    assert replace(differs, slope=0.04).agree
    assert not replace(differs, slope=0.0, force=-0.021).agree
