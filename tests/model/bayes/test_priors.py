# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from model.bayes.priors import Below, HalfNormal, LogNormal, Normal, StudentT, Truncated, Uniform

NAMED = (
    (Normal(0.3, 2.0), stats.norm(0.3, 2.0)),
    (StudentT(0.01, 0.02), stats.t(3, 0.01, 0.02)),
    (LogNormal(10.0, 1.5), stats.lognorm(s=1.5, scale=10.0)),
    (HalfNormal(0.15), stats.halfnorm(scale=0.15)),
    (Uniform(-0.5, 0.99), stats.uniform(-0.5, 1.49)),
    (Truncated(1.6, 0.3, 1.0, 2.0), stats.truncnorm(-2.0, 4 / 3, loc=1.6, scale=0.3)),
    (Truncated(0.1, 0.1, 0.0, np.inf), stats.truncnorm(-1.0, np.inf, loc=0.1, scale=0.1)),
)
PRIORS = (*(prior for prior, _ in NAMED), Below(1.0, 1.0, 1.0), Below(1.0, 0.2, 0.5))
SUPPORTS = {
    Normal: (-np.inf, np.inf),
    StudentT: (-np.inf, np.inf),
    LogNormal: (0.0, np.inf),
    HalfNormal: (0.0, np.inf),
    Uniform: (-0.5, 0.99),
    Below: (-np.inf, 1.0),
    Truncated: (0.0, np.inf),
}
every_prior = pytest.mark.parametrize("prior", PRIORS, ids=lambda prior: prior.describe())
Z = st.floats(-5.0, 5.0)


@every_prior
@given(z=Z)
def test_a_coordinate_survives_the_way_to_the_value_and_back(prior, z):
    # The last digit of a value beside its bound is worth 1e-10 of a coordinate at z = 5.
    assert prior.coordinate(prior.value(z)) == pytest.approx(z, abs=1e-8)


@every_prior
@given(lower=Z, step=st.floats(1e-6, 5.0))
def test_a_larger_coordinate_means_a_larger_value(prior, lower, step):
    assert prior.value(lower + step) > prior.value(lower)


@every_prior
@given(z=st.floats(-8.0, 8.0))
def test_every_value_lies_inside_the_support(prior, z):
    lower, upper = SUPPORTS[type(prior)]
    assert lower < prior.value(z) < upper


@pytest.mark.parametrize(("prior", "named"), NAMED, ids=lambda item: type(item).__name__)
def test_a_standard_normal_becomes_the_named_distribution(prior, named):
    probability = np.array([1e-6, 0.05, 0.25, 0.5, 0.75, 0.95, 1 - 1e-6])
    quantiles = prior.value(stats.norm.ppf(probability))
    np.testing.assert_allclose(quantiles, named.ppf(probability), rtol=1e-8)


def test_below_one_is_one_minus_a_log_normal():
    probability = np.array([0.001, 0.05, 0.5, 0.95, 0.999])
    gap = 1 - Below(1.0, 0.4, 0.8).value(stats.norm.ppf(probability))
    np.testing.assert_allclose(gap, stats.lognorm(s=0.8, scale=0.4).isf(probability))


def test_half_normal_keeps_its_digits_in_both_tails():
    prior = HalfNormal(0.15)
    # |N| near 0 has density sqrt(2/pi)/scale: its quantile there is p·scale·sqrt(pi/2).
    tiny = stats.norm.cdf(-12.0) * 0.15 * np.sqrt(np.pi / 2)
    large = 0.15 * stats.norm.isf(stats.norm.sf(12.0) / 2)
    np.testing.assert_allclose(prior.value([-12.0, 12.0]), [tiny, large], rtol=1e-12)
    np.testing.assert_allclose(prior.coordinate(prior.value([-12.0, 12.0])), [-12.0, 12.0])


def test_a_value_out_of_a_bounded_support_has_no_finite_coordinate():
    with np.errstate(invalid="ignore"):
        coordinates = [Uniform(0.0, 1.0).coordinate(value) for value in (-0.1, 0.0, 1.0, 1.1)]
    assert not np.isfinite(coordinates).any()


@every_prior
def test_arrays_map_entry_by_entry(prior):
    z = np.linspace(-2.0, 2.0, 6).reshape(2, 3)
    np.testing.assert_array_equal(prior.value(z), [[prior.value(x) for x in row] for row in z])


@every_prior
def test_a_description_names_the_family_and_its_numbers(prior):
    numbers = [f"{number:g}" for number in vars(prior).values()]
    assert all(number in prior.describe() for number in numbers)
    assert prior.describe().startswith(
        ("normal", "lognormal", "half-normal", "uniform", "1 - log", "Student")
    )
