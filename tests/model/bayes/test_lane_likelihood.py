# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from scipy.linalg import solve_triangular

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.lane_likelihood import lane_log_likelihood
from model.bayes.likelihood import (
    NUISANCE,
    covariance_factors,
    predict_blocks,
    run_log_likelihood,
)
from model.slip import Brush, CoulombStribeck, MagicFormula, SlipDefinition
from model.slip.lane_force import lane_law
from model.slip.lanes import LANES

LAWS = [
    MagicFormula(),
    MagicFormula("constant", load_sensitivity=True, reference_load=6.0),
    Brush(),
    CoulombStribeck(),
]
TYPICAL = {
    "slip_stiffness": 20.0, "shape": 1.5, "friction": 0.4, "peak_slip_per_load": 0.0066,
    "curvature": -0.5, "friction_load_exponent": -0.1, "stiffness_load_exponent": 0.2,
    "kinetic_ratio": 0.8, "stribeck_slip": 0.1, "gain_traction": 0.01, "gain_normal": -0.01,
    "bias_normal": 0.1, "crosstalk": 0.02, "radius_error": 0.004, "rolling_resistance": 0.02,
    "slip_error_scale": 1.3, "slip_scatter": 0.002, "noise_floor": 0.1, "noise_correlation": 0.4,
    "offset_spread": 0.1,
}  # fmt: skip


def blocks(seed=0, sizes=(1, 4, 9, 2)):
    """Return blocks with slip errors and with slip and load that vary within a block."""
    rng, n = np.random.default_rng(seed), sum(sizes)
    return SlipBlocks(
        slip=rng.uniform(-0.3, 0.5, n),
        normal_force=rng.uniform(2.0, 12.0, n),
        traction_force=rng.uniform(-3.0, 3.0, n),
        count=np.full(n, 10),
        run=np.repeat(np.arange(len(sizes)), sizes),
        run_names=tuple(map(str, range(len(sizes)))),
        definition=SlipDefinition.MATERIAL,
        slip_wander=rng.uniform(0.0, 1e-4, n),
        slip_error=rng.uniform(0.0, 1e-5, n),
        load_variance=rng.uniform(0.0, 0.3, n),
        load_skewness=rng.normal(0.0, 0.5, n),
        slip_load_covariance=rng.normal(0.0, 1e-4, n),
        run_slip_error=rng.uniform(0.0, 1e-6, len(sizes)),
        load_error=rng.uniform(0.0, 1e-2, n),
        noise_size=rng.uniform(0.5, 2.0, n),
    )


def vectors(law, count, seed=1):
    """Return parameter vectors near typical ones, shape (count, k + 11)."""
    middle = np.array([TYPICAL[p.name] for p in (*law.parameters, *NUISANCE)])
    return middle * np.random.default_rng(seed).uniform(0.9, 1.1, (count, len(middle)))


def by_definition(data, law, values):
    """Compute the same densities by a dense covariance of each run."""
    predicted = predict_blocks(data, law, values)
    found = np.empty((len(values), data.n_runs))
    for w, row in enumerate(values):
        one = predicted.of_vector(w)
        factors = covariance_factors(data, one, row)
        residual = data.traction_force - one.force
        for i, L in enumerate(factors):
            white = solve_triangular(L, residual[data.run == i], lower=True)
            found[w, i] = -0.5 * (white @ white + len(white) * np.log(2 * np.pi))
            found[w, i] -= np.log(np.diag(L)).sum()
    return found


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize("count", [1, LANES, 2 * LANES + 1])
def test_lanes_give_the_densities_of_the_definition(law, count):
    data, values = blocks(), vectors(law, count)
    found = run_log_likelihood(data, law, values)
    np.testing.assert_allclose(found, by_definition(data, law, values), rtol=1e-9)


def test_a_law_without_lanes_has_the_same_density():
    law = MagicFormula()

    class Wrapped:
        name, parameters = "wrapped", law.parameters
        force, slip_derivative = staticmethod(law.force), staticmethod(law.slip_derivative)
        valid, peak_slip = staticmethod(law.valid), staticmethod(law.peak_slip)

    values = vectors(law, 3)
    np.testing.assert_allclose(
        run_log_likelihood(blocks(), Wrapped(), values),
        run_log_likelihood(blocks(), law, values),
        rtol=1e-9,
    )


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_parameters_beyond_any_number_give_no_density_above_that_of_no_misfit(law):
    rng = np.random.default_rng(2)
    data, middle = blocks(), vectors(law, 400)
    values = middle * np.exp(rng.normal(0.0, 60.0, middle.shape))
    values[:, -2] = rng.uniform(-1.0, 1.0, len(values))
    known, k = lane_law(law, values[:, : len(law.parameters)]), len(law.parameters)
    found = lane_log_likelihood(data, known, values[:, k:]).sum(axis=1)
    with np.errstate(all="ignore"):  # no variance is below that of what is new in the noise
        new = data.noise_size * values[:, -3, None] * np.sqrt(1 - values[:, -2, None] ** 2)
        highest = -np.log(new * np.sqrt(2 * np.pi)).sum(axis=1)
    assert 0 < np.isfinite(found).sum() < len(found)
    assert not (found > highest + 1e-9 * np.abs(highest)).any()
