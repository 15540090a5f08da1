# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import stats

from model.bayes.averaging.blocks import block_means
from model.bayes.likelihood import NUISANCE, log_likelihood
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.priors import HalfNormal, Normal
from model.slip import Brush, CoulombStribeck, MagicFormula
from model.slip.law import Parameter
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep

PLAN = SweepPlan(slips=(0.0, 0.05, 0.2, 0.6), loads=(2.13, 12.75), duration=0.4)
BLOCKS = block_means(
    simulate_sweep(
        THESIS_LAW,
        THESIS_VALUES,
        plan=PLAN,
        imperfections=TYPICAL_RIG,
        rng=np.random.default_rng(0),
    ).samples,
    20,
)
LAWS = (
    THESIS_LAW,
    MagicFormula(curvature="constant", load_sensitivity=True, reference_load=6.63),
    CoulombStribeck(),
    Brush(),
)
every_law = pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)


def posterior(law=THESIS_LAW, **fixed):
    return SlipPosterior(BLOCKS, law, default_priors(law, BLOCKS, LoadCell()), fixed)


def truth():
    law_values = {p.name: v for p, v in zip(THESIS_LAW.parameters, THESIS_VALUES, strict=True)}
    return {**law_values, "noise_floor": 0.01, "noise_correlation": 0.2, "offset_spread": 0.05}


def wide(d):
    return arrays(float, (3, d), elements=st.floats(-40.0, 40.0))


# --- the density


@every_law
@given(data=st.data())
def test_the_log_density_is_a_number_or_minus_infinity_never_nan(law, data):
    target = posterior(law)
    heights = target.log_density(data.draw(wide(len(target.free))))
    assert heights.shape == (3,)
    assert not np.isnan(heights).any()
    assert not np.any(heights == np.inf)


def test_out_of_the_laws_shape_the_density_is_zero():
    target = posterior()
    # E > 1 at the heaviest load: a late peak with a large shape factor.
    bent = target.coordinates({**truth(), "shape": 1.9, "peak_slip_per_load": 0.1})
    heights = target.log_density(np.stack([target.coordinates(truth()), bent]))
    assert np.isfinite(heights[0])
    assert heights[1] == -np.inf


@every_law
def test_the_density_is_the_prior_times_the_likelihood(law):
    target = posterior(law)
    z = 0.1 * np.random.default_rng(1).standard_normal((5, len(target.free)))
    z[:, [p.name for p in target.free].index("noise_floor")] += 2  # no needle-sharp likelihood
    likelihood = log_likelihood(BLOCKS, law, target.values(z))
    np.testing.assert_allclose(target.log_density(z), target.log_prior(z) + likelihood)
    inside = np.isfinite(target.log_prior(z))
    prior = stats.norm.logpdf(z).sum(axis=1)
    np.testing.assert_allclose(target.log_prior(z)[inside], prior[inside])


# --- coordinates and values


@every_law
@given(data=st.data())
def test_values_and_coordinates_are_each_others_inverse(law, data):
    target = posterior(law)
    z = data.draw(arrays(float, len(target.free), elements=st.floats(-4.0, 4.0)))
    values = target.values(z[None])[0]
    named = {p.name: v for p, v in zip(target.parameters, values, strict=True)}
    np.testing.assert_allclose(target.coordinates(named), z, atol=1e-8)


@every_law
def test_a_coordinate_a_free_parameter_the_laws_first_then_the_measurements(law):
    target = posterior(law)
    names = [p.name for p in target.parameters]
    assert names == [p.name for p in (*law.parameters, *NUISANCE)]
    assert len(target.free) == len(names)
    assert target.values(np.zeros((2, len(names)))).shape == (2, len(names))


@every_law
@given(data=st.data())
def test_every_value_lies_inside_its_parameters_support(law, data):
    target = posterior(law)
    z = data.draw(arrays(float, (3, len(target.free)), elements=st.floats(-5.0, 5.0)))
    values = target.values(z)
    for parameter, column in zip(target.parameters, values.T, strict=True):
        assert np.all((parameter.lower < column) & (column < parameter.upper))


def test_parameters_left_unnamed_start_at_their_prior_median():
    target = posterior()
    z = target.coordinates({"friction": 0.4})
    at_friction = [p.name for p in target.free].index("friction")
    np.testing.assert_array_equal(np.delete(z, at_friction), 0.0)
    assert target.values(z[None])[0, at_friction] == pytest.approx(0.4)


# --- fixed parameters


def test_a_fixed_parameter_keeps_its_value_and_has_no_coordinate():
    target = posterior(noise_correlation=0.0, shape=1.5)
    assert len(target.free) == len(target.parameters) - 2
    z = np.random.default_rng(2).standard_normal((4, len(target.free)))
    names = [p.name for p in target.parameters]
    values = target.values(z)
    np.testing.assert_array_equal(values[:, names.index("shape")], 1.5)
    np.testing.assert_array_equal(values[:, names.index("noise_correlation")], 0.0)


def test_fixing_a_parameter_where_it_was_leaves_the_likelihood_alone():
    free, fixed = posterior(), posterior(noise_correlation=0.2)
    likelihoods = [
        target.run_log_likelihood(target.coordinates(truth())[None]) for target in (free, fixed)
    ]
    np.testing.assert_allclose(likelihoods[1], likelihoods[0], rtol=1e-9)


# --- without some runs


def test_without_some_runs_the_others_keep_their_densities_and_priors():
    target = posterior()
    left_out = np.arange(BLOCKS.n_runs) % 3 == 0
    fewer = target.without_runs(left_out)
    z = target.coordinates(truth())[None]
    expected = target.run_log_likelihood(z)[:, ~left_out]
    np.testing.assert_allclose(fewer.run_log_likelihood(z), expected, rtol=1e-12)
    np.testing.assert_array_equal(fewer.values(z), target.values(z))
    assert fewer.priors is target.priors


# --- the priors chosen


@every_law
def test_every_parameter_gets_a_prior(law):
    priors = default_priors(law, BLOCKS, LoadCell())
    assert list(priors) == [p.name for p in (*law.parameters, *NUISANCE)]


def test_a_load_cells_certificate_sets_its_priors():
    cell = LoadCell(zero_stability=0.3, gain_sd=0.01, bias_sd=0.2, crosstalk_sd=0.02)
    priors = default_priors(THESIS_LAW, BLOCKS, cell)
    assert priors["offset_spread"] == HalfNormal(0.3)
    assert priors["gain_traction"] == priors["gain_normal"] == Normal(0.0, 0.01)
    assert priors["bias_normal"] == Normal(0.0, 0.2)
    assert priors["crosstalk"] == Normal(0.0, 0.02)


class Linear:
    """A law the default priors have never heard of, with every kind of support."""

    name = "linear"
    parameters = (
        Parameter("lift", "a", "dimensionless", 0.0, np.inf, "positive"),
        Parameter("lean", "b", "dimensionless", -np.inf, np.inf, "any"),
        Parameter("blend", "c", "dimensionless", -1.0, 3.0, "bounded"),
        Parameter("least", "d", "dimensionless", 2.0, np.inf, "at least 2"),
        Parameter("most", "e", "dimensionless", -np.inf, -0.5, "at most -0.5"),
    )


def test_an_unknown_laws_parameters_get_broad_priors_over_their_support():
    priors = default_priors(Linear(), BLOCKS, LoadCell())
    z = np.linspace(-5.0, 5.0, 11)
    for parameter in Linear.parameters:
        values = priors[parameter.name].value(z)
        assert np.all((parameter.lower < values) & (values < parameter.upper))
        assert np.ptp(values) > 3
