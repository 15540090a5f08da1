# SPDX-License-Identifier: MIT
"""The information of runs is the inverse covariance that they add, and grows with their length."""

import numpy as np
import pytest
from scipy.linalg import solve_triangular

from model.bayes.likelihood import covariance_factors, predict_blocks
from model.design.information import (
    conditions_of,
    measured_information,
    planned_blocks,
    run_roots,
    usable_draws,
    white_sizes,
)
from model.errors import InsufficientData
from support.small_layouts import layout
from support.small_layouts import posterior as posterior_of


@pytest.fixture(scope="module")
def posterior():
    blocks = layout(error=0.002, wander=0.003, load_sd=0.05)
    return posterior_of(blocks)


@pytest.fixture(scope="module")
def draws(posterior):
    rng = np.random.default_rng(1)
    return usable_draws(posterior, 0.3 * rng.standard_normal((8, len(posterior.free))), 3)


def test_information_of_measured_runs_is_that_of_the_linear_problem(posterior, draws):
    found = measured_information(posterior, draws)
    z, blocks, step = draws[0], posterior.blocks, 1e-4
    values = posterior.values(z[None])
    centre = predict_blocks(blocks, posterior.law, values)
    factors = covariance_factors(blocks, centre.of_vector(0), values[0])
    dense = np.zeros((len(blocks), len(blocks)))
    for start, factor in zip(blocks.run_starts(), factors, strict=False):
        part = slice(start, start + len(factor))
        dense[part, part] = factor @ factor.T
    steps = step * np.eye(len(z))
    forces = [predict_blocks(blocks, posterior.law, posterior.values(z + s * steps)).force
              for s in (1, -1)]  # fmt: skip
    jacobian = (forces[0] - forces[1]).T / (2 * step)
    gain = jacobian.T @ np.linalg.solve(dense, jacobian)
    covariance = np.linalg.inv(np.eye(len(z)) + gain)
    assert np.linalg.inv(covariance) - np.eye(len(z)) == pytest.approx(
        found[0], rel=1e-3, abs=1e-3 * np.abs(gain).max()
    )


def test_a_planned_run_has_the_information_of_its_blocks_measured(posterior, draws):
    conditions = conditions_of(posterior.blocks)
    one = planned_blocks(np.array([0.05]), np.array([6.0]), conditions, posterior.blocks)
    roots = run_roots(
        posterior, one, draws, n_blocks=np.array([3.0]), shared=np.array([1.0])
    )  # fmt: skip
    many = planned_blocks(np.full(3, 0.05), np.full(3, 6.0), conditions, posterior.blocks)
    run = type(many)(**{**vars(many), "run": np.zeros(3, int), "run_names": ("a",),
                        "run_slip_error": many.run_slip_error[:1]})  # fmt: skip
    measured = measured_information(type(posterior)(run, posterior.law, posterior.priors), draws)
    root = roots[:, 0, 0]
    assert root[:, :, None] * root[:, None] == pytest.approx(measured, rel=1e-4, abs=1e-6)


def test_more_blocks_never_tell_less(posterior, draws):
    conditions = conditions_of(posterior.blocks)
    slip, load = np.linspace(-0.3, 0.6, 9), np.full(9, 8.0)
    blocks = planned_blocks(slip, load, conditions, posterior.blocks)
    n = np.array([0.5, 1.0, 1.5, 2.0, 7.0, 20.0])
    roots = run_roots(posterior, blocks, draws, n_blocks=n, shared=1 / n)
    sizes = np.linalg.norm(roots, axis=-1)
    assert np.all(np.diff(sizes, axis=1) >= -1e-12)


@pytest.mark.parametrize("rho", [-0.3, 0.0, 0.8])
def test_the_filter_gives_the_sum_of_the_inverse_covariance(rho):
    noise, scatter = np.array([0.2, 0.5]), np.array([0.0, 0.1])
    found = white_sizes(noise, scatter, rho=rho, most=6)
    lags = np.abs(np.subtract.outer(np.arange(6), np.arange(6)))
    for i in range(2):
        covariance = noise[i] ** 2 * np.power(rho, lags) + scatter[i] * np.eye(6)
        for n in range(1, 7):
            white = solve_triangular(np.linalg.cholesky(covariance[:n, :n]), np.ones(n), lower=True)
            assert found[n - 1, i] == pytest.approx(white @ white)


def test_conditions_are_medians_relative_to_the_load():
    blocks = layout(error=0.002, wander=0.003, load_sd=0.05, skewness=0.4)
    found = conditions_of(blocks)
    assert (found.length, found.samples) == (20, 60)
    assert found.load_spread == pytest.approx(0.05)
    assert found.load_skewness == pytest.approx(0.4)
    assert (found.slip_wander, found.slip_error, found.run_slip_error) == pytest.approx(
        (9e-6, 4e-6, 4e-6)
    )


def test_draws_outside_the_support_are_left_out(posterior, draws):
    outside = np.full((2, draws.shape[1]), np.inf)
    assert usable_draws(posterior, np.vstack([outside, draws]), 2).tolist() == draws[:2].tolist()
    with pytest.raises(InsufficientData, match="none of 0 posterior draws"):
        usable_draws(posterior, outside, 2)
