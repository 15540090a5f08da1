# SPDX-License-Identifier: MIT
"""Blocks are simulated as the data are described, by other means than the likelihood."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.likelihood import log_likelihood, predict_blocks
from model.slip.definition import SlipDefinition, slip_per_radius_error
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from support.simulated_blocks import simulate_blocks, slip_of_true_radii
from support.small_layouts import LAW, layout

RIG = (0.01, -0.02, 0.1, 0.02, 0.01, 0.03)
QUIET = (1.0, 0.0, 0.0, 0.0, 0.0)


def mean(blocks, values, law=THESIS_LAW):
    given = np.array([*values, *RIG, *QUIET])
    return simulate_blocks(blocks, law, given, rng=np.random.default_rng(1)).traction_force


def test_without_noise_the_mean_is_the_likelihoods():
    blocks = layout(wander=0.003, load_sd=0.05, skewness=0.5)
    expected = predict_blocks(blocks, THESIS_LAW, np.array([[*THESIS_VALUES, *RIG, *QUIET]]))
    assert mean(blocks, THESIS_VALUES) == pytest.approx(expected.force[0], abs=2e-3)


@pytest.mark.parametrize("definition", SlipDefinition)
def test_a_small_error_of_the_radii_shifts_slip_as_its_derivative_says(definition):
    slip = np.array([-0.4, -0.1, 0.1, 0.5])
    shifted = slip_of_true_radii(slip, 1e-6, definition)
    assert (slip - shifted) / 1e-6 == pytest.approx(
        slip_per_radius_error(slip, definition), abs=1e-5
    )


def test_skewed_loads_have_the_blocks_moments():
    blocks = layout(load_sd=0.2, skewness=-1.5)
    proportional = (1000.0, 0.5)  # saturated everywhere: traction is friction times the load
    known = np.array([*proportional, *np.zeros(6), *QUIET])
    found = simulate_blocks(blocks, LAW, known, rng=np.random.default_rng(1)).traction_force
    assert np.abs(found) == pytest.approx(0.5 * blocks.normal_force, rel=1e-9)


def test_noise_has_its_size_memory_and_offsets():
    blocks = layout(n_runs=400, blocks_a_run=10)
    # So slippery that the zero of load, which scatters alike, moves no force.
    values = np.array([20.0, 1e-3, *np.zeros(6), 1.0, 0.0, 0.2, 0.6, 0.3])
    quiet = np.array([20.0, 1e-3, *np.zeros(6), *QUIET])
    rng = np.random.default_rng(3)
    noise = (
        simulate_blocks(blocks, LAW, values, rng=rng).traction_force
        - simulate_blocks(blocks, LAW, quiet, rng=rng).traction_force
    ).reshape(400, 10)
    assert noise.var() == pytest.approx(0.2**2 + 0.3**2, rel=0.1)
    step = np.mean((noise[:, 1:] - noise[:, :-1]) ** 2) / (2 * 0.2**2)
    assert 1 - step == pytest.approx(0.6, abs=0.03)
    far = np.mean(noise[:, 0] * noise[:, 9])
    assert far == pytest.approx(0.3**2, abs=0.02)


def test_slip_errors_of_block_and_run_reach_the_force():
    blocks = layout(n_runs=300, blocks_a_run=2, error=0.002)
    blocks = replace(blocks, slip=np.zeros(len(blocks)))
    values = np.array([20.0, 0.4, *np.zeros(6), *QUIET])
    found = simulate_blocks(blocks, LAW, values, rng=np.random.default_rng(2)).traction_force
    pairs = (found / (20.0 * blocks.normal_force)).reshape(-1, 2)  # the law's slope at zero
    assert pairs.var() == pytest.approx(2 * 0.002**2, rel=0.15)
    assert np.mean(pairs[:, 0] * pairs[:, 1]) == pytest.approx(0.002**2, rel=0.3)


def test_the_truth_is_likelier_than_others():
    blocks = layout(n_runs=40)
    true = np.array([20.0, 0.4, *np.zeros(6), 1.0, 0.0, 0.05, 0.3, 0.05])
    other = true.copy()
    other[1] = 0.44
    data = simulate_blocks(blocks, LAW, true, rng=np.random.default_rng(5))
    ratio = np.diff(log_likelihood(data, LAW, np.array([other, true])))
    assert ratio > 10
