# SPDX-License-Identifier: MIT
"""An earlier posterior as a prior gives what all data together give."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy import stats

from model.bayes.drawing.laplace import LaplaceMixture, find_mode, hessian
from model.bayes.fit import PreparedFit, prepare_fit
from model.bayes.posterior import LoadCell, default_priors
from model.bayes.preliminary import BlockChoice
from model.bayes.priors import HalfNormal, LogNormal, Normal, Uniform
from model.bayes.stated_priors import (
    EarlierPosterior,
    Moved,
    PriorCorrelation,
    StatedPriors,
    with_stated,
)
from model.errors import DomainError
from model.slip.rig_errors import RigErrors
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.quick_fits import few_starts
from support.simulated_sweep import simulate_sweep

NOISE = {"slip_error_scale", "slip_scatter", "noise_floor", "noise_correlation", "offset_spread"}
PERFECT = RigErrors(1e-4, 1e-3)  # so that one side of zero slip is nearly Gaussian
BASE = {"a": Normal(1.0, 2.0), "b": LogNormal(0.4, 0.5), "c": Uniform(0.0, 1.0)}


def correlated(n=4000, seed=0):
    """Draws of a, b and c whose coordinates have known means, spreads and a correlation."""
    rng = np.random.default_rng(seed)
    covariance = np.array([[0.04, 0.03, 0.0], [0.03, 0.09, 0.0], [0.0, 0.0, 0.01]])
    z = rng.multivariate_normal([0.5, -0.2, 0.1], covariance, n)
    return {name: prior.value(z[:, i]) for i, (name, prior) in enumerate(BASE.items())}


def test_an_earlier_posterior_keeps_mean_spread_and_correlation():
    draws = correlated()
    priors, correlation = with_stated(BASE, StatedPriors(earlier=EarlierPosterior(draws, "x")))
    u = np.random.default_rng(1).standard_normal((200_000, 3))
    y = u @ correlation.root(tuple(BASE))
    again = {name: priors[name].value(y[:, i]) for i, name in enumerate(BASE)}
    for name in BASE:
        assert np.mean(again[name]) == pytest.approx(np.mean(draws[name]), rel=0.01)
        assert np.std(again[name]) == pytest.approx(np.std(draws[name]), rel=0.05)
    one, other = (np.corrcoef(x["a"], np.log(x["b"]))[0, 1] for x in (draws, again))
    assert one == pytest.approx(other, abs=0.02)


def test_an_earlier_posterior_is_named_in_the_prior():
    priors, _ = with_stated(BASE, StatedPriors(earlier=EarlierPosterior(correlated(), "2025")))
    assert "2025" in priors["a"].describe()


@pytest.mark.parametrize("base", [Normal(0.3, 2.0), LogNormal(10, 1.5), HalfNormal(0.2)])
def test_a_moved_prior_maps_back_and_is_itself_where_it_is_not_moved(base):
    z = np.linspace(-3, 3, 13)
    moved = Moved(base, 0.4, 0.2, "x")
    np.testing.assert_allclose(moved.coordinate(moved.value(z)), z, atol=1e-8)
    np.testing.assert_allclose(Moved(base, 0.0, 1.0, "x").value(z), base.value(z))


def test_the_root_of_a_correlation_squares_to_it_and_leaves_others_alone():
    matrix = np.array([[1.0, -0.9], [-0.9, 1.0]])
    correlation = PriorCorrelation(("p", "q"), matrix)
    order = ("q", "other", "p")
    root = correlation.root(order)
    np.testing.assert_allclose((root @ root)[np.ix_([2, 0], [2, 0])], matrix, atol=1e-12)
    np.testing.assert_allclose(root[1], [0, 1, 0])
    np.testing.assert_allclose(root @ correlation.root(order, inverse=True), np.eye(3), atol=1e-12)


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        (
            StatedPriors({"a": Normal(0, 1)}, EarlierPosterior(correlated(), "x")),
            "a: a prior of its own, and one from x",
        ),
        (StatedPriors(earlier=EarlierPosterior(correlated(50), "x")), "50 usable draws"),
        (
            StatedPriors(earlier=EarlierPosterior(
                {**correlated(), "c": np.linspace(0.5, 1.2, 4000)}, "x"
            )),
            "lie outside what this fit allows",
        ),
    ],
)  # fmt: skip
def test_an_earlier_posterior_that_cannot_be_a_prior_is_refused(stated, message):
    with pytest.raises(DomainError, match=message):
        with_stated(BASE, stated)


# --- halves of an experiment, by Laplace approximations


@cache
def samples() -> SlipSamples:
    plan = SweepPlan(slips=tuple(np.linspace(0.004, 0.8, 24) ** 1.5), loads=(4.0, 12.0), rate=60.0)
    rng = np.random.default_rng(3)
    return simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng
    ).samples


def some_runs(half: int) -> SlipSamples:
    whole = samples()
    rows = whole.run % 2 == half
    return SlipSamples(
        whole.slip[rows], whole.normal_force[rows], whole.traction_force[rows],
        whole.run[rows] // 2, whole.run_names[half::2], whole.definition, whole.time[rows],
    )  # fmt: skip


@few_starts()
def fitted(data: SlipSamples, stated: StatedPriors = StatedPriors()) -> PreparedFit:  # noqa: B008
    return prepare_fit(
        data, THESIS_LAW, load_cell=LoadCell(), rig_errors=PERFECT, rng=np.random.default_rng(1),
        block_choice=BlockChoice(6, None, "as asked for"), validate=False, stated=stated,
    )  # fmt: skip


@cache
def all_runs() -> dict[str, np.ndarray]:
    return drawn(fitted(samples()))


@cache
def last_year() -> dict[str, np.ndarray]:
    return drawn(fitted(some_runs(0)))


def drawn(fit: PreparedFit, n=20_000) -> dict[str, np.ndarray]:
    """Draws of the Gaussian at the mode, as values by name."""
    rng = np.random.default_rng(7)
    z = rng.multivariate_normal(fit.laplace.mode, fit.laplace.covariance, n)
    values = fit.posterior.values(z)
    return {p.name: values[:, i] for i, p in enumerate(fit.posterior.parameters)}


def unsheared(fit: PreparedFit) -> PreparedFit:
    """Return a fit whose Gaussian is that of the coordinates without a shear."""
    plain = replace(fit.posterior, shear=None)
    mode = find_mode(plain.log_density, fit.laplace.mode[None])  # where a shear has its fixed point
    return replace(fit, posterior=plain, approximation=LaplaceMixture((mode,)))


CARRIED = ("slip_stiffness", "shape", "friction", "peak_slip_per_load", "gain_traction",
           "gain_normal", "bias_normal", "crosstalk")  # fmt: skip


def test_last_year_s_half_as_prior_of_this_year_s_half_is_all_data():
    earlier = EarlierPosterior(last_year(), "last year")
    halves, whole = drawn(fitted(some_runs(1), StatedPriors(earlier=earlier))), all_runs()
    alone = drawn(fitted(some_runs(1)))
    for name in CARRIED:
        sd = whole[name].std()
        assert abs(halves[name].mean() - whole[name].mean()) < 0.2 * sd, name
        # Each half tells the noise of its own runs.
        assert halves[name].std() == pytest.approx(sd, rel=0.08), name
    assert alone["slip_stiffness"].std() > 1.2 * whole["slip_stiffness"].std()


def test_without_the_load_cell_s_correlations_the_halves_would_say_too_much():
    """Plant the fault: margins alone count the gain of the load cell twice."""
    draws = last_year()
    rng = np.random.default_rng(2)
    apart = {name: rng.permutation(values) for name, values in draws.items()}
    earlier = EarlierPosterior(apart, "last year")
    halves, whole = drawn(fitted(some_runs(1), StatedPriors(earlier=earlier))), all_runs()
    assert halves["friction"].std() < 0.9 * whole["friction"].std()


def test_an_earlier_posterior_gives_the_product_of_its_density_and_the_likelihood():
    data = some_runs(1)
    earlier = EarlierPosterior(last_year(), "last year")
    fit = unsheared(fitted(data, StatedPriors(earlier=earlier)))  # Gaussian in plain coordinates
    posterior = fit.posterior
    base = default_priors(THESIS_LAW, posterior.blocks, LoadCell())
    names = [p.name for p in posterior.free]
    z = np.column_stack([base[name].coordinate(earlier.draws[name]) for name in names])
    prior = stats.multivariate_normal(z.mean(axis=0), np.cov(z.T))

    def product(points):
        """Log density in the coordinates of the default priors."""
        values = np.column_stack([base[n].value(points[:, i]) for i, n in enumerate(names)])
        own = np.column_stack(
            [posterior.priors[n].coordinate(values[:, i]) for i, n in enumerate(names)]
        )
        inner = own @ posterior.correlation.root(names, inverse=True)
        return prior.logpdf(points) + posterior.run_log_likelihood(inner).sum(axis=1)

    centre = np.array([
        base[n].coordinate(posterior.values(fit.laplace.mode[None])[0, i])
        for i, n in enumerate(names)
    ])  # fmt: skip
    expected = np.linalg.inv(-hessian(product, centre))
    found = drawn(fit)
    for i, name in enumerate(names):
        if name in NOISE:  # far from Gaussian, unlike the Hessian's posterior
            continue
        spread = base[name].coordinate(found[name]).std()
        assert spread == pytest.approx(np.sqrt(expected[i, i]), rel=0.05), name


def test_a_single_prior_is_that_parameter_s_and_moves_the_posterior():
    stated = StatedPriors({"friction": Normal(0.5, 0.002), "curvature": Normal(0, 1)})
    fit = fitted(some_runs(1), stated)
    assert fit.posterior.priors["friction"] == Normal(0.5, 0.002)
    assert fit.posterior.correlation is None
    assert "curvature" not in fit.posterior.priors  # of another law
    assert drawn(fit)["friction"].mean() > all_runs()["friction"].mean() + 0.02
