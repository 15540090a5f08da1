# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import block_diag, toeplitz
from scipy.stats import multivariate_normal, skew

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.likelihood import (
    NUISANCE,
    log_likelihood,
    predict_blocks,
    run_log_likelihood,
)
from model.slip import Brush, CoulombStribeck, MagicFormula, SidedLaw, SlipDefinition
from rig.slip_rig.imperfections import bump_rise

LAW = MagicFormula(curvature=0.0)  # proportional to load exactly, as the covariance term assumes
LAW_VALUES = (20.0, 1.5, 0.38)
SLIP_SCALE = LAW_VALUES[2] / LAW_VALUES[0]  # where the initial slope would reach the peak
SIZES = (1, 4, 9, 1, 6)
LAWS = (
    LAW,
    MagicFormula(),
    MagicFormula("constant", load_sensitivity=True, reference_load=6.0),
    Brush(),
    CoulombStribeck(),
    CoulombStribeck(stribeck=False),
    SidedLaw(Brush()),
    SidedLaw(MagicFormula("peak", load_sensitivity=True, reference_load=6.0)),
)
TYPICAL = {
    "slip_stiffness": 20.0, "shape": 1.5, "friction": 0.38, "peak_slip_per_load": 0.0066,
    "curvature": -0.5, "friction_load_exponent": -0.1, "stiffness_load_exponent": 0.2,
    "kinetic_ratio": 0.8, "stribeck_slip": 0.1, "side_stiffness": 0.3, "side_friction": -0.2,
}  # fmt: skip


def parameters(**nuisance):
    """Return one parameter vector, shape (1, k + 11), of 0 unless named.

    Noise is 0.1 N, and slip errors are as estimated.
    """
    known = {"noise_floor": 0.1, "slip_error_scale": 1.0, **nuisance}
    return np.array([[*LAW_VALUES, *(known.get(p.name, 0.0) for p in NUISANCE)]])


def blocks(sizes=SIZES, seed=0, **replaced):
    rng = np.random.default_rng(seed)
    n = sum(sizes)
    exact = SlipBlocks(
        slip=rng.uniform(-0.1, 0.5, n),
        normal_force=rng.uniform(2.0, 10.0, n),
        traction_force=rng.uniform(-1.0, 4.0, n),
        count=np.full(n, 10),
        run=np.repeat(np.arange(len(sizes)), sizes),
        run_names=tuple(f"run {index}" for index in range(len(sizes))),
        definition=SlipDefinition.MATERIAL,
        slip_wander=np.zeros(n),
        slip_error=np.zeros(n),
        load_variance=np.zeros(n),
        load_skewness=np.zeros(n),
        slip_load_covariance=np.zeros(n),
        run_slip_error=np.zeros(len(sizes)),
        load_error=np.zeros(n),
        noise_size=np.ones(n),
    )
    return replace(exact, **replaced)


def single_blocks(slip, load, force):
    """Return runs of one block each: as many one-dimensional densities."""
    n = np.broadcast(slip, load, force).size
    full = {
        name: np.broadcast_to(np.asarray(column, dtype=float), n)
        for name, column in (("slip", slip), ("normal_force", load), ("traction_force", force))
    }
    return blocks((1,) * n, **full)


def blurred_blocks(sizes=SIZES, seed=0):
    """Return blocks with every kind of slip error, some of them zero."""
    rng = np.random.default_rng(seed + 1)
    n = sum(sizes)
    own = rng.uniform(0.0, 1e-4, n) * (rng.random(n) < 0.7)
    shared = rng.uniform(0.0, 1e-4, len(sizes)) * (rng.random(len(sizes)) < 0.7)
    wander = rng.uniform(0.0, 1e-4, n)
    return blocks(
        sizes, seed, slip_error=own, run_slip_error=shared, slip_wander=wander,
        load_error=rng.uniform(0, 0.01, sum(sizes)), noise_size=rng.uniform(0.5, 2, sum(sizes)),
    )  # fmt: skip


@pytest.mark.parametrize("stiffness", [1e6, 1e10, 4e14])
@pytest.mark.parametrize("noise_floor", [1e-6, 1e-10, 3e-14])
def test_rounding_makes_no_density_of_a_misfit(stiffness, noise_floor):
    data = blurred_blocks()
    values = parameters(noise_floor=noise_floor, offset_spread=0.01)
    values[0, 0] = stiffness
    density = run_log_likelihood(data, LAW, values)
    # A density is largest where nothing is left over; the noise floor bounds every variance below.
    sizes = np.array(SIZES)
    assert (density <= -sizes * (np.log(noise_floor) + 0.5 * np.log(2 * np.pi)) + 1e-9).all()


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_parameters_beyond_any_number_give_no_density_above_that_of_no_misfit(law):
    rng, data = np.random.default_rng(2), blurred_blocks()
    measurement = parameters(slip_scatter=0.002, offset_spread=0.1, crosstalk=0.02)[0]
    middle = [*(TYPICAL[p.name] for p in law.parameters), *measurement[len(LAW_VALUES) :]]
    values = middle * np.exp(rng.normal(0.0, 60.0, (400, len(middle))))
    values[:, -2] = rng.uniform(-1.0, 1.0, len(values))
    with np.errstate(all="ignore"):  # no variance is below that of what is new in the noise
        found = log_likelihood(data, law, values)
        new = data.noise_size * values[:, -3, None] * np.sqrt(1 - values[:, -2, None] ** 2)
        highest = -np.log(new * np.sqrt(2 * np.pi)).sum(axis=1)
    assert np.isfinite(found).any()
    assert not (found > highest + 1e-9 * np.abs(highest)).any()


def dense_covariances(data, predicted, *, rho, tau, scale=1.0, scatter=0.0):
    """Build every run's covariance from the data model, term by term."""
    covariances = []
    for run in range(data.n_runs):
        rows = data.run == run
        s, g = predicted.noise[0, rows], predicted.slope[0, rows]
        h = predicted.load_slope[0, rows]
        powers = np.power(rho, np.arange(len(s)), dtype=float)  # 0**0 is 1: white noise
        correlated = np.diag(s) @ toeplitz(powers) @ np.diag(s)
        offset = tau**2 * (np.ones((len(s), len(s))) + np.outer(h, h))
        shared_error = scale**2 * data.run_slip_error[run] * np.outer(g, g)
        own_error = np.diag(
            g**2 * (scale**2 * data.slip_error[rows] + scatter**2) + h**2 * data.load_error[rows]
        )
        covariances.append(correlated + offset + shared_error + own_error)
    return covariances


def dense_log_densities(data, values):
    predicted = predict_blocks(data, LAW, values)
    residual = data.traction_force - predicted.force[0]
    scale, scatter, *_, rho, tau = values[0, -5:]
    covariances = dense_covariances(data, predicted, rho=rho, tau=tau, scale=scale, scatter=scatter)
    return [
        multivariate_normal(cov=covariance).logpdf(residual[data.run == run])
        for run, covariance in enumerate(covariances)
    ]


# --- the filter


@given(
    seed=st.integers(0, 1000),
    rho=st.one_of(st.just(0.0), st.floats(-0.95, 0.98)),
    tau=st.one_of(st.just(0.0), st.floats(0.0, 2.0)),
    noise_floor=st.floats(0.02, 1.0),
    gain=st.floats(-0.1, 0.1),
    bias=st.floats(-0.5, 0.5),
    crosstalk=st.floats(-0.1, 0.1),
)
def test_the_filter_is_the_dense_gaussian_of_the_definition(seed, rho, tau, gain, **other):
    values = parameters(
        noise_correlation=rho,
        offset_spread=tau,
        gain_traction=gain,
        gain_normal=-gain,
        noise_floor=other["noise_floor"],
        bias_normal=other["bias"],
        crosstalk=other["crosstalk"],
    )
    data = blurred_blocks(seed=seed)
    found = run_log_likelihood(data, LAW, values)[0]
    np.testing.assert_allclose(found, dense_log_densities(data, values), rtol=1e-9, atol=1e-7)


@pytest.mark.parametrize("size", [{"slip_error_scale": 1.7}, {"slip_scatter": 0.01}])
def test_the_size_of_slip_errors_is_a_parameter(size):
    data, values = blurred_blocks(), parameters(offset_spread=0.1, **size)
    expected = dense_log_densities(data, values)
    np.testing.assert_allclose(run_log_likelihood(data, LAW, values)[0], expected, rtol=1e-9)
    assert abs(log_likelihood(data, LAW, values) - log_likelihood(data, LAW, parameters())) > 0.1


def test_many_parameter_vectors_at_once_are_each_on_its_own():
    rng = np.random.default_rng(3)
    values = parameters(noise_correlation=0.4, offset_spread=0.2) * rng.uniform(0.9, 1.1, (7, 1))
    data = blurred_blocks()
    one_by_one = [run_log_likelihood(data, LAW, row[None])[0] for row in values]
    np.testing.assert_array_equal(run_log_likelihood(data, LAW, values), one_by_one)


# --- runs


def test_runs_are_independent_and_their_log_densities_add():
    values = parameters(noise_correlation=0.7, offset_spread=0.3)
    data = blurred_blocks()
    whole = run_log_likelihood(data, LAW, values)[0]
    for run in range(data.n_runs):
        alone = data.select_runs(np.arange(data.n_runs) == run)
        np.testing.assert_allclose(log_likelihood(alone, LAW, values), whole[run], rtol=1e-12)
    np.testing.assert_allclose(log_likelihood(data, LAW, values), whole.sum(), rtol=1e-12)


def test_a_likelihood_of_all_runs_is_one_gaussian_of_blocks_on_a_diagonal():
    values = parameters(noise_correlation=-0.3, offset_spread=0.3)
    data = blurred_blocks()
    predicted = predict_blocks(data, LAW, values)
    covariance = block_diag(*dense_covariances(data, predicted, rho=-0.3, tau=0.3))
    residual = data.traction_force - predicted.force[0]
    expected = multivariate_normal(cov=covariance).logpdf(residual)
    np.testing.assert_allclose(log_likelihood(data, LAW, values)[0], expected, rtol=1e-10)


# --- crosstalk


@pytest.mark.parametrize("crosstalk", [-0.3, 0.0, 0.3])
def test_the_density_of_traction_integrates_to_one_under_crosstalk(crosstalk):
    values = parameters(crosstalk=crosstalk, gain_traction=0.1)
    force = np.linspace(-2.0, 6.0, 8001)
    log_density = run_log_likelihood(single_blocks(0.05, 5.0, force), LAW, values)[0]
    assert np.trapezoid(np.exp(log_density), force) == pytest.approx(1.0, abs=1e-3)


def test_what_was_measured_does_not_move_the_prediction():
    data, values = blocks(), parameters(crosstalk=0.3)
    other = replace(data, traction_force=data.traction_force + 1.0)
    np.testing.assert_array_equal(
        predict_blocks(other, LAW, values).force, predict_blocks(data, LAW, values).force
    )


# --- the law averaged over a block


def numeric_mean(slip, sd, load):
    """Average the law over Gaussian slip by a fine Riemann sum."""
    deviation = np.linspace(-8.0, 8.0, 4001)
    weight = np.exp(-0.5 * deviation**2)
    weight /= weight.sum()
    return LAW.force(slip[:, None] + sd * deviation, load, LAW_VALUES) @ weight


def averaging_error(spread):
    """Return the largest error of a block's mean force along the curve, over the peak force."""
    slip = np.linspace(-0.1, 0.3, 81)
    data = single_blocks(slip, 5.0, 1.0)
    data = replace(data, slip_wander=np.full(len(data), (spread * SLIP_SCALE) ** 2))
    found = predict_blocks(data, LAW, parameters()).force[0]
    peak = LAW_VALUES[2] * 5.0
    return np.abs(found - numeric_mean(slip, spread * SLIP_SCALE, 5.0)).max() / peak


@pytest.mark.parametrize(("spread", "tolerance"), [(0.05, 1e-6), (0.3, 1e-5), (1.0, 0.02)])
def test_a_blocks_mean_force_is_the_law_averaged_over_its_wander(spread, tolerance):
    assert averaging_error(spread) < tolerance


def test_the_law_at_the_mean_slip_would_be_a_hundred_times_worse():
    slip = np.linspace(-0.1, 0.3, 81)
    blunt = LAW.force(slip, 5.0, LAW_VALUES) - numeric_mean(slip, 0.3 * SLIP_SCALE, 5.0)
    assert np.abs(blunt).max() / (LAW_VALUES[2] * 5.0) > 100 * averaging_error(0.3) / 5


def test_wander_and_both_slip_errors_blunt_the_curve_alike():
    kinds = ({"slip_wander": 3e-5}, {"slip_error": 3e-5}, {"run_slip_error": 3e-5})
    data = blocks()
    forces = [
        predict_blocks(
            replace(data, **{name: np.full_like(getattr(data, name), size)}), LAW, parameters()
        ).force
        for kind in kinds
        for name, size in kind.items()
    ]
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-12)
    np.testing.assert_allclose(forces[2], forces[0], rtol=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_without_wander_a_block_is_the_law_itself_and_its_slope(law):
    law_values = [TYPICAL[p.name] for p in law.parameters]
    values = np.array([[*law_values, *parameters()[0, len(LAW_VALUES) :]]])
    data = blocks()
    predicted = predict_blocks(data, law, values)
    arguments = (data.slip, data.normal_force, law_values)
    np.testing.assert_allclose(predicted.force[0], law.force(*arguments), rtol=1e-6)
    slope = law.slip_derivative(*arguments)
    np.testing.assert_allclose(predicted.slope[0], slope, rtol=1e-6, atol=1e-6)


def test_slip_and_load_that_vary_together_add_their_covariance():
    rng = np.random.default_rng(8)
    slip, load = rng.multivariate_normal([1e-4, 5.0], [[1e-10, 5e-6], [5e-6, 1.0]], 400).T
    data = single_blocks(slip.mean(), load.mean(), 1.0)
    covariance = np.mean((slip - slip.mean()) * (load - load.mean()))
    data = replace(
        data,
        slip_load_covariance=np.array([covariance]),
        load_variance=np.array([np.var(load)]),
        load_skewness=np.array([skew(load)]),
    )
    found = predict_blocks(data, LAW, parameters()).force[0, 0]
    in_line = LAW.force(slip, load, LAW_VALUES).mean()  # at so little slip the law is a line
    assert found == pytest.approx(in_line, rel=1e-5)
    assert found != pytest.approx(LAW.force(slip.mean(), load.mean(), LAW_VALUES), rel=1e-3)


def test_a_load_that_bumps_is_averaged_over_with_its_skewness():
    angle = np.linspace(0.0, 1.5, 400)  # a bump of 60 % under two thirds of the block
    load = 5.0 * (1 + bump_rise(angle - 0.6, height=0.6, width=1.0))
    law, law_values = MagicFormula("peak"), (20.0, 1.56, 0.38, 0.0066)
    values = np.array([[*law_values, *parameters()[0, len(LAW_VALUES) :]]])
    data = replace(
        single_blocks(0.03, load.mean(), 1.0),
        load_variance=np.array([np.var(load)]),
        load_skewness=np.array([skew(load)]),
    )
    expected = law.force(0.03, load, law_values).mean()
    found = predict_blocks(data, law, values).force[0, 0]
    at_the_mean = law.force(0.03, load.mean(), law_values)
    assert abs(found - expected) < 0.1 * abs(at_the_mean - expected)


# --- the load cell


def test_gains_bias_and_crosstalk_act_where_the_data_model_puts_them():
    values = parameters(gain_traction=0.1, gain_normal=0.2, bias_normal=0.3, crosstalk=0.05)
    data = blocks()
    load = 1.2 * data.normal_force - 0.3
    load = load + 0.05 * 1.1 * LAW.force(data.slip, load, LAW_VALUES)
    expected = 1.1 * LAW.force(data.slip, load, LAW_VALUES)
    np.testing.assert_allclose(predict_blocks(data, LAW, values).force[0], expected, rtol=1e-6)


def test_a_gain_common_to_both_channels_cancels_in_the_friction():
    gain = 0.02
    data = blocks()
    both = predict_blocks(data, LAW, parameters(gain_traction=gain, gain_normal=-gain / (1 + gain)))
    neither = predict_blocks(data, LAW, parameters())
    np.testing.assert_allclose(both.force, neither.force, rtol=1e-12)


def test_a_bias_that_pushes_the_load_through_zero_leaves_a_finite_density():
    values = parameters(bias_normal=50.0)
    assert np.all(np.isfinite(run_log_likelihood(blocks(), LAW, values)))


def test_noise_has_the_size_of_its_run_and_nothing_of_the_curve():
    sizes = np.linspace(0.5, 2.0, len(blocks()))
    predicted = predict_blocks(blocks(noise_size=sizes), LAW, parameters())
    np.testing.assert_allclose(predicted.noise[0], 0.1 * sizes)


@pytest.mark.parametrize(
    ("crosstalk", "wander", "follow", "error"),
    [
        (-0.02, 0.003, 0.0, 2e-4),
        (0.02, 0.003, 0.0, 2e-4),
        (-0.05, 0.008, 0.0, 0.03),
        (0.05, 0.008, 0.0, 0.03),
        (0.02, 0.006, 0.01, 0.06),
    ],
)
def test_slip_follows_the_true_load_and_not_that_which_crosstalk_moves(
    crosstalk, wander, follow, error
):
    """Traction that wanders moves the measured load, though the true load does not follow it."""
    rng = np.random.default_rng(9)
    of_load = rng.standard_normal((3, 4000))
    slip = np.array([-0.02, 0.01, 0.02])[:, None] + wander * rng.standard_normal((3, 4000))
    slip += follow * of_load
    true_load = 5.0 * (1 + 10 * follow * of_load)
    force = LAW.force(slip, true_load, LAW_VALUES)
    load = true_load - crosstalk * force
    deviation = slip - slip.mean(axis=1, keepdims=True)
    data = replace(
        blocks((3,)),
        slip=slip.mean(axis=1),
        normal_force=load.mean(axis=1),
        slip_wander=slip.var(axis=1),
        load_variance=load.var(axis=1),
        load_skewness=skew(load, axis=1),
        slip_load_covariance=np.mean(deviation * load, axis=1),
    )
    predicted = predict_blocks(data, LAW, parameters(crosstalk=crosstalk)).force[0]
    np.testing.assert_allclose(predicted, force.mean(axis=1), rtol=0, atol=error)
