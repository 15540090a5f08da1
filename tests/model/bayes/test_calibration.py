# SPDX-License-Identifier: MIT
"""What a calibration says of a fit agrees with the fit's own draws."""

import numpy as np
import pytest

from model.bayes.calibration import conclude
from model.bayes.convergence import assess
from model.bayes.fit import prepare_fit
from model.bayes.posterior import LoadCell
from model.bayes.sampler import advance, start_chains
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep


@pytest.fixture(scope="module")
def calibration():
    rng = np.random.default_rng(2)
    plan = SweepPlan(slips=tuple(np.linspace(0.005, 0.3, 8)), loads=(4.0, 12.0), rate=40.0)
    samples = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng
    ).samples
    fit = prepare_fit(samples, THESIS_LAW, load_cell=LoadCell(), rng=rng, threads=1)
    density = fit.posterior.log_density
    chains = start_chains(density, fit.approximation, ensembles=2, thin=5, rng=rng)
    chains = advance(density, chains, steps=100, approximation=fit.approximation, threads=1)
    return conclude(
        fit, None, chains, assess(chains), samples, source="sim:test", seconds=1.5, rng=rng
    )


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


def test_the_source_says_whether_data_were_simulated(calibration):
    assert calibration.simulated
    assert (calibration.source, calibration.seconds) == ("sim:test", 1.5)
