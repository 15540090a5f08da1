# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.drawing.convergence import Convergence
from model.bayes.drawing.sampler import Chains
from model.bayes.drawing.weighted import WeightedDraws
from model.bayes.estimate import (
    Draws,
    Estimate,
    agreement,
    contraction,
    curve_estimates,
    estimate,
    thin_draws,
)
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.slip import Brush, CoulombStribeck, MagicFormula
from model.slip.definition import SlipDefinition
from model.slip.law import Parameter, SlipLaw
from model.slip.magic_formula import peak_slip

ANY = Parameter("x", "x", "newton", -math.inf, math.inf, "anything")
RNG = np.random.default_rng(3)
CONVERGENCE = Convergence(
    0, 1000, *([np.ones(11)] * 2), *([np.full(11, 5e3)] * 2), np.full(11, 0.01)
)


def posterior() -> SlipPosterior:
    """Put together a posterior of two runs, with the load cell's gains known."""
    n = 8
    zeros = np.zeros(n)
    blocks = SlipBlocks(
        slip=np.tile(np.linspace(0.01, 0.4, 4), 2), normal_force=np.full(n, 5.0),
        traction_force=np.full(n, 1.5), count=np.full(n, 10), run=np.repeat([0, 1], 4),
        run_names=("a", "b"), definition=SlipDefinition.MATERIAL, slip_wander=zeros,
        slip_error=zeros, load_variance=zeros, load_skewness=zeros, slip_load_covariance=zeros,
        run_slip_error=np.zeros(2), load_error=zeros, noise_size=np.ones(n),
    )  # fmt: skip
    law = Brush()
    priors = default_priors(law, blocks, LoadCell())
    return SlipPosterior(blocks, law, priors, {"gain_traction": 0.0, "gain_normal": 0.0})


def draws_of(z: np.ndarray) -> Draws:
    return Draws(z, posterior().values(z), np.zeros(z.shape[:2]))


def test_estimate_of_normal_draws_is_their_moments_and_quantiles():
    found = estimate(ANY, RNG.normal(3.0, 2.0, 200_000))
    assert (found.mean, found.sd, found.median) == pytest.approx((3.0, 2.0, 3.0), abs=0.03)
    assert (found.low, found.high) == pytest.approx((3 - 3.29, 3 + 3.29), abs=0.03)


@given(st.lists(st.floats(-1e6, 1e6) | st.just(math.inf), min_size=1, max_size=50))
def test_quantiles_are_draws_in_order_even_where_some_are_infinite(draws):
    found = estimate(ANY, np.array(draws))
    assert found.low <= found.median <= found.high
    assert {found.low, found.median, found.high} <= set(draws)
    assert math.isnan(found.sd) == (math.inf in draws)


def by_symbol(law: SlipLaw, values: np.ndarray, **where: float) -> dict[str, Estimate]:
    return {e.parameter.symbol: e for e in curve_estimates(law, values, **where)}


def test_plain_coefficients_are_those_of_the_source():
    values = np.tile([34.34 * 1.564 * 0.38, 1.564, 0.38, 0.0], (3, 1))
    found = by_symbol(MagicFormula("constant"), values, load=6.63, slip_limit=1.0)
    assert list(found) == ["B", "C", "D", "E", "x_m", "F_max", "BCD"]
    medians = [found[symbol].median for symbol in ("B", "C", "D", "E")]
    assert medians == pytest.approx([34.34, 1.564, 0.38 * 6.63, 0.0])
    assert found["x_m"].median == pytest.approx(peak_slip(34.34, 1.564, 0.0))
    assert found["F_max"].median == pytest.approx(0.38 * 6.63)
    assert found["BCD"].median == pytest.approx(34.34 * 1.564 * 0.38 * 6.63)
    assert all(e.sd == pytest.approx(0.0, abs=1e-9) for e in found.values())


@pytest.mark.parametrize("law", [Brush(), CoulombStribeck(stribeck=False)])
def test_curve_without_a_peak_reports_it_at_infinity_and_its_full_force(law):
    values = np.tile([20.0, 0.4], (50, 1))
    found = by_symbol(law, values, load=5.0, slip_limit=1.0)
    assert list(found) == ["x_m", "F_max", "BCD"]
    assert found["x_m"].median == math.inf
    assert found["F_max"].median == pytest.approx(2.0)
    assert found["BCD"].median == pytest.approx(100.0)


def test_largest_force_is_sought_within_the_tested_slip():
    law, values = MagicFormula("constant"), np.tile([20.0, 1.4, 1.2, 0.2], (3, 1))
    peak = float(law.peak_slip(5.0, values[0]))
    short, whole = (
        by_symbol(law, values, load=5.0, slip_limit=limit)["F_max"].median
        for limit in (peak / 3, 3 * peak)
    )
    assert short == pytest.approx(law.force(peak / 3, 5.0, values[0]))
    assert whole == pytest.approx(1.2 * 5.0)


def test_thinned_draws_lie_behind_the_burn_in_and_keep_their_ensemble():
    d = len(posterior().free)
    z = np.zeros((4, 20, 6, d))
    z[:, :8] = 9.0
    z[:, 8:] += np.arange(4)[:, None, None, None] / 10
    chains = Chains(
        z, z[..., 0], np.ones(4), 5, np.zeros((4, 624), dtype=np.uint32), np.zeros(4, dtype=int)
    )
    ones = np.ones(d)
    kept = thin_draws(posterior(), chains, Convergence(8, 11, *[ones] * 5), n=30)
    assert kept.z.shape == (4, 30, d)
    assert kept.values.shape == (4, 30, 2 + 11)
    assert kept.flat.shape == (120, 2 + 11)
    for ensemble in range(4):
        assert np.all(kept.z[ensemble] == ensemble / 10)
    np.testing.assert_array_equal(kept.log_density, kept.z[..., 0])


def test_thinning_gives_every_draw_once_where_fewer_are_kept_than_asked_for():
    d = len(posterior().free)
    z = RNG.normal(size=(4, 5, 3, d))
    chains = Chains(
        z, z[..., 0], np.ones(4), 5, np.zeros((4, 624), dtype=np.uint32), np.zeros(4, dtype=int)
    )
    kept = thin_draws(posterior(), chains, Convergence(0, 5, *[np.ones(d)] * 5), n=1000)
    np.testing.assert_array_equal(kept.z, z.reshape(4, 15, d))


def test_contraction_is_0_where_the_posterior_is_the_prior_and_1_where_it_is_a_point():
    d = len(posterior().free)
    z = RNG.normal(size=(4, 20_000, d))
    z[..., 0] *= 1e-3
    z[..., 1] *= 0.5
    found = contraction(posterior(), draws_of(z))
    assert list(found) == [p.name for p in posterior().free]
    assert "gain_traction" not in found
    stiffness, friction, *others = found.values()
    assert (stiffness, friction) == pytest.approx((1.0, 0.75), abs=0.02)
    assert others == pytest.approx([0.0] * len(others), abs=0.05)


def weighted(z: np.ndarray, pareto_k: float = 0.3) -> WeightedDraws:
    return WeightedDraws(z, np.full(len(z), 1 / len(z)), pareto_k, np.zeros(len(z)))


def test_engines_with_the_same_draws_agree_exactly():
    z = RNG.normal(size=(4, 500, len(posterior().free)))
    found = agreement(draws_of(z), weighted(z.reshape(2000, -1)), CONVERGENCE)
    assert (found.mean, found.spread) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert found.comparable


def test_disagreement_is_that_of_the_worst_parameter():
    z = RNG.normal(size=(4, 500, len(posterior().free)))
    other = z.reshape(2000, -1).copy()
    other[:, 2] += 0.5 * other[:, 2].std()
    other[:, 3] = 1.2 * (other[:, 3] - other[:, 3].mean()) + other[:, 3].mean()
    found = agreement(draws_of(z), weighted(other), CONVERGENCE)
    assert (found.mean, found.spread) == pytest.approx((0.5, 0.2))


def test_weights_with_a_heavy_tail_are_not_compared():
    z = RNG.normal(size=(4, 50, len(posterior().free)))
    heavy = weighted(z.reshape(200, -1), pareto_k=0.71)
    assert not agreement(draws_of(z), heavy, CONVERGENCE).comparable
