# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from model.bayes.drawing.convergence import BURN_IN, assess, assess_weighted
from model.bayes.drawing.sampler import Chains


def chains(z):
    """Return chains of these coordinates, shape (ensembles, steps, walkers, d)."""
    ensembles = len(z)
    return Chains(
        z=z,
        log_density=np.zeros(z.shape[:3]),
        accepted=np.full(ensembles, 0.3),
        thin=1,
        random_keys=np.zeros((ensembles, 624), dtype=np.uint32),
        random_positions=np.zeros(ensembles, dtype=int),
    )


def walks(*, ensembles=4, steps=600, walkers=16, d=2, rho=0.5, seed=0):
    """Draw stationary AR(1) walks of unit variance, shape (ensembles, steps, walkers, d)."""
    rng = np.random.default_rng(seed)
    shock = rng.standard_normal((ensembles, steps, walkers, d))
    shock[:, 1:] *= np.sqrt(1 - rho**2)
    return lfilter([1.0], [1.0, -rho], shock, axis=1)


def test_chains_of_one_distribution_have_converged():
    found = assess(chains(walks()))
    assert found.failures() == []
    assert found.converged
    assert found.fraction_done() == 1.0
    assert found.r_hat.shape == found.ess_bulk.shape == found.ess_tail.shape == (2,)


@pytest.mark.parametrize("coordinate", [0, 1])
def test_two_ensembles_apart_are_named_by_their_r_hat(coordinate):
    z = walks()
    z[:2, :, :, coordinate] += 0.5
    found = assess(chains(z))
    assert found.r_hat[coordinate] > 1.01
    assert found.r_hat[1 - coordinate] <= 1.01
    assert [text for text in found.failures() if text.startswith("R-hat between ensembles is 1.0")]
    assert not found.converged


def test_walkers_stuck_apart_in_every_ensemble_alike_are_not_r_hats_business_but_are_found():
    # Each ensemble covers the same two places, so ensembles agree; no walker crosses over.
    z = walks()
    z[:, :, ::2] += 6.0
    found = assess(chains(z))
    assert found.r_hat.max() <= 1.01
    assert any("effective sample size" in text for text in found.failures())


def test_ensembles_of_different_spread_are_found_although_their_means_agree():
    z = walks()
    z[0] *= 3
    assert any(text.startswith("R-hat") for text in assess(chains(z)).failures())


def test_a_short_chain_is_named_with_its_length_and_the_rule():
    found = assess(chains(walks(steps=150, rho=0.9)))
    (text,) = [text for text in found.failures() if "chain length" in text]
    assert text.endswith("at least 50 needed")
    assert 0.05 < found.fraction_done() < 0.5


def test_every_rule_can_break_alone_and_is_then_the_only_one_named():
    good = assess(chains(walks()))
    breaking = {
        "R-hat": {"r_hat": np.array([1.0, 1.02])},
        "Monte Carlo error": {"mcse": np.array([0.06, 0.01])},
        "bulk": {"ess_bulk": np.array([399.0, 5000.0])},
        "tail": {"ess_tail": np.array([5000.0, 399.0])},
        "chain length": {"length": 10},
    }
    for rule, change in breaking.items():
        (text,) = replace(good, **change).failures()
        assert text.startswith(rule)
    edge = replace(good, r_hat=np.array([1.01, 1.01]), ess_bulk=np.array([400.0, 400.0]))
    assert edge.converged


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9])
def test_effective_size_and_error_are_those_of_an_ar1(rho):
    found = assess(chains(walks(steps=2000, rho=rho)))
    time = (1 + rho) / (1 - rho)
    draws = 4 * 16 * found.length
    np.testing.assert_allclose(found.autocorrelation_time, time, rtol=0.15)
    np.testing.assert_allclose(found.ess_bulk, draws / time, rtol=0.15)
    np.testing.assert_allclose(found.mcse, np.sqrt(time / draws), rtol=0.1)


def test_burn_in_covers_the_way_from_a_bad_start_and_no_more_than_half():
    z = walks(rho=0.8)
    z += 30 * 0.8 ** np.arange(z.shape[1])[:, None, None]
    found = assess(chains(z))
    assert found.burn_in + found.length == z.shape[1]
    assert found.burn_in >= BURN_IN * found.autocorrelation_time.max()
    assert found.converged
    stuck = assess(chains(walks(steps=40, rho=0.99)))
    assert stuck.burn_in == 20


def test_the_summary_gives_the_worst_coordinates_figures():
    found = assess(chains(walks()))
    text = found.summary()
    assert f"R-hat {found.r_hat.max():.3f}" in text
    assert f"bulk ESS {found.ess_bulk.min():.0f}" in text


@pytest.mark.parametrize("name", ["autocorrelation_time", "r_hat", "ess_bulk", "ess_tail", "mcse"])
def test_a_diagnostic_that_cannot_be_computed_is_not_met(name):
    found = assess(chains(walks()))
    unknown = np.full_like(getattr(found, name), np.nan)
    failures = replace(found, **{name: unknown}).failures()
    assert len(failures) == 1
    assert " is nan, " in failures[0]


def weighted(slope=0.0, *, n=40_000, pareto_k=0.1):
    """Assess standard normal draws in two coordinates whose log weights rise with the first."""
    z = np.random.default_rng(8).standard_normal((n, 2))
    weights = np.exp(slope * z[:, 0])
    weights /= weights.sum()
    part = np.random.default_rng(9).choice(n, size=(4, 1000), p=weights)
    return assess_weighted(z[part], z, weights, pareto_k)


def test_equal_weights_are_worth_all_draws():
    found = weighted()
    np.testing.assert_allclose([found.ess_bulk, found.ess_tail], 40_000, rtol=1e-9)
    assert found.converged
    assert "Pareto k of the weights 0.10" in found.summary()


def test_unequal_weights_are_worth_what_the_variance_of_a_weighted_mean_says():
    # Of weights exp(s x) of a standard normal x, E w² (h - E h)² is exp(s²) E_2s (h - s)², with
    # mean 2s: 1 + s² times as much for x itself, once as much for a coordinate beside it.
    found = weighted(0.4)
    expected = 40_000 * np.exp(-(0.4**2)) / np.array([1 + 0.4**2, 1.0])
    np.testing.assert_allclose(found.ess_bulk, expected, rtol=0.05)
    assert (found.ess_tail < 40_000).all()


def test_weights_with_a_heavy_tail_are_not_converged():
    (text,) = weighted(pareto_k=0.7).failures()
    assert text == "tail index of the weights (Pareto k) is 0.70, below 0.7 needed"
