# SPDX-License-Identifier: MIT
"""Searches start at the curve and in the prior; a posterior along a curve is straightened."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.approximation import FEW_BLOCKS, starting_points, straightened
from model.bayes.averaging.blocks import block_means
from model.bayes.drawing.laplace import LaplaceMixture
from model.bayes.drawing.tails import approximate
from model.bayes.drawing.weighted import importance_draws
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.priors import Normal
from model.slip import MagicFormula
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.plain_samples import fit_blocks
from support.simulated_sweep import simulate_sweep

LAW, TRUTH = MagicFormula("constant"), (20.4, 1.56, 0.38, 0.0)


@pytest.fixture(scope="module")
def one_sided():
    """Return the posterior of many slips of one sign and its approximation, without a shear."""
    plan = SweepPlan(slips=tuple(np.linspace(0.002, 1.0, 24)), loads=(4.0, 12.0), rate=200.0)
    rng = np.random.default_rng(2)
    quiet = replace(
        TYPICAL_RIG, offset_sd=1e-3, noise_sd0=3e-3, noise_sd1=2e-3, speed_noise=2e-3,
        slip_wander_sd=0.0,
    )  # fmt: skip
    samples = simulate_sweep(LAW, TRUTH, plan=plan, imperfections=quiet, rng=rng).samples
    blocks = block_means(samples, 40)
    # Normal: in the coordinate of the default Student's t no shear is found here.
    priors = default_priors(LAW, blocks, LoadCell()) | {"rolling_resistance": Normal(0.0, 0.02)}
    posterior = SlipPosterior(blocks, LAW, priors)
    start = dict(zip((p.name for p in LAW.parameters), TRUTH, strict=True))
    start |= {"noise_floor": 0.05}
    return posterior, approximate(posterior.log_density, posterior.coordinates(start)[None])


def test_searches_of_few_blocks_start_in_the_prior_too(one_sided):
    posterior, _ = one_sided
    plain = fit_blocks(
        posterior.blocks, LAW, priors=posterior.priors, zero_sd=0.01, rng=np.random.default_rng(1)
    )
    many = starting_points(posterior, plain, np.random.default_rng(1))
    first = np.zeros(posterior.blocks.n_runs, dtype=bool)
    first[::4] = True
    few = starting_points(posterior.without_runs(~first), plain, np.random.default_rng(1))
    assert len(posterior.blocks) < FEW_BLOCKS
    assert few.shape[1] == many.shape[1] == len(posterior.free)
    assert np.isfinite(posterior.log_density(few)).all()
    assert len(few) >= 14


def test_slips_of_one_sign_are_straightened_to_the_same_posterior_with_better_weights(one_sided):
    posterior, approximation = one_sided
    straight, mixture = straightened(posterior, approximation, np.random.default_rng(3))
    assert straight.shear is not None
    z = approximation.draw(50, rng=np.random.default_rng(4))
    x = straight.shear.straightened(z)
    np.testing.assert_allclose(straight.log_density(x), posterior.log_density(z), rtol=1e-9)
    np.testing.assert_allclose(straight.values(x), posterior.values(z), rtol=1e-9)
    known = {"friction": 0.5, "rolling_resistance": 0.01}
    back = straight.values(straight.coordinates(known)[None])[0]
    names = [p.name for p in straight.parameters]
    assert {n: back[names.index(n)] for n in known} == pytest.approx(known)
    before, after = (
        importance_draws(each.log_density, each_mixture, n=2000, rng=np.random.default_rng(5))
        for each, each_mixture in ((posterior, approximation), (straight, mixture))
    )
    assert after.reliable
    assert after.effective_size > 1.5 * before.effective_size


def test_a_posterior_of_several_modes_is_left_as_it_is(one_sided):
    posterior, approximation = one_sided
    mode = approximation.modes[0]
    two = LaplaceMixture((mode, replace(mode, mode=mode.mode + 1.0)))
    same, mixture = straightened(posterior, two, np.random.default_rng(1))
    assert same is posterior
    assert mixture is two
