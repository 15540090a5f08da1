# SPDX-License-Identifier: MIT
"""What the sampler's jumps propose, and that it changes how fast is sampled and not what."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.drawing.jumps import FEW, MANY, choose_jumps
from model.bayes.drawing.laplace import Laplace, LaplaceMixture, find_mode
from model.bayes.drawing.sampler import Jumps, advance, autocorrelation_times, start_chains
from model.bayes.drawing.weighted import importance_draws


def leaning(z):
    """Log density of four skewed coordinates, logarithms of gamma variables, of shape 1.5."""
    return np.sum(1.5 * z - np.exp(z), axis=1)


LAPLACE = LaplaceMixture((find_mode(leaning, np.zeros((1, 4))),))


def chosen(density=leaning, approximation=LAPLACE, *, n=10_000, seed=1):
    rng = np.random.default_rng(seed)
    weighted = importance_draws(density, approximation, n=n, rng=rng)
    return weighted, choose_jumps(density, approximation, weighted, rng=rng)


def test_jumps_to_the_fitted_mixture_are_accepted_more_often():
    weighted, jumps = chosen()
    tried = importance_draws(leaning, jumps.proposal, n=4000, rng=np.random.default_rng(5))
    assert tried.jumps > weighted.jumps + 0.1
    assert jumps.share == MANY


@pytest.mark.long
def test_they_shorten_the_autocorrelation_time_and_leave_the_density_as_it_is():
    start = start_chains(leaning, LAPLACE, ensembles=4, thin=2, rng=np.random.default_rng(3))
    plain = advance(leaning, start, steps=250, jumps=Jumps(LAPLACE.distribution, MANY))
    fitted = advance(leaning, start, steps=250, jumps=chosen()[1])
    assert autocorrelation_times(fitted.z).max() < 0.7 * autocorrelation_times(plain.z).max()
    z = fitted.z[:, 20:].reshape(-1, 4)
    np.testing.assert_allclose(z.mean(axis=0), 0.03649, atol=0.03)  # digamma(1.5)
    np.testing.assert_allclose(z.var(axis=0), 0.9348, rtol=0.04)  # trigamma(1.5)


def test_a_mode_that_the_weighted_draws_missed_is_still_jumped_to():
    def two(z):
        far = -0.5 * np.sum((z - 9) ** 2, axis=1)
        return np.logaddexp(np.log(0.5) + far, np.log(0.5) - 0.5 * np.sum(z**2, axis=1))

    both = LaplaceMixture(
        (Laplace(np.zeros(2), np.eye(2), 0.0), Laplace(np.full(2, 9.0), np.eye(2), 0.0))
    )
    rng = np.random.default_rng(2)
    one = LaplaceMixture(both.modes[:1])
    weighted = replace(importance_draws(two, one, n=4000, rng=rng), jumps=0.0)
    jumps = choose_jumps(two, both, weighted, rng=rng)
    assert len(jumps.proposal.weights) > len(both.modes)
    start = start_chains(two, one, ensembles=4, thin=2, rng=rng)
    walked = advance(two, start, steps=300, jumps=jumps)
    assert np.mean(walked.z[:, 60:, :, 0] > 4.5) == pytest.approx(0.5, abs=0.05)


@pytest.mark.parametrize(
    "change", [{"pareto_k": 0.9}, {"weights": np.eye(1, 10_000)[0]}, {"jumps": 1.0}]
)
def test_the_laplace_approximation_is_kept_where_nothing_better_is_known(change):
    weighted, _ = chosen()
    rng = np.random.default_rng(4)
    jumps = choose_jumps(leaning, LAPLACE, replace(weighted, **change), rng=rng)
    np.testing.assert_array_equal(jumps.proposal.centres, LAPLACE.distribution.centres)


@pytest.mark.parametrize(("accepted", "share"), [(0.05, FEW), (0.3, MANY)])
def test_most_moves_jump_where_jumps_are_likely_to_be_accepted(accepted, share):
    weighted, _ = chosen()
    known = replace(weighted, pareto_k=0.9, jumps=accepted)
    jumps = choose_jumps(leaning, LAPLACE, known, rng=np.random.default_rng(4))
    assert jumps.share == share
