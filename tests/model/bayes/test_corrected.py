# SPDX-License-Identifier: MIT
"""Corrected blocks scatter about the true curve by their noise alone."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.likelihood import corrected_blocks
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from support.simulated_blocks import simulate_blocks, slip_of_true_radii
from support.small_layouts import layout

RIG = (0.05, -0.02, 0.3, 0.02, 0.01, 0.09)  # gains, bias, crosstalk, radii, rolling resistance


def known(*, noise, rho=0.0, tau=0.0):
    """Return the true values of law and measurement."""
    return np.array([*THESIS_VALUES, *RIG, 1.0, 0.0, noise, rho, tau])


def corrected(blocks, *, noise, rho=0.0, tau=0.0, zeros=True):
    """Return simulated blocks, these corrected by the true values, and what is left over."""
    values = known(noise=noise, rho=rho, tau=tau)
    rng = np.random.default_rng(1)
    measured = simulate_blocks(blocks, THESIS_LAW, values, rng=rng)
    found = corrected_blocks(measured, THESIS_LAW, values, zeros=zeros)
    law = THESIS_LAW.force(found.slip, found.normal_force, THESIS_VALUES)
    return measured, found, found.traction_force - law


def test_without_noise_the_law_of_the_true_slip_and_load_is_left():
    blocks = layout()
    measured, found, rest = corrected(blocks, noise=1e-9)
    gain, gain_normal, bias, crosstalk, epsilon, resistance = RIG
    load = (1 + gain_normal) * blocks.normal_force - bias + crosstalk * measured.traction_force
    slip = slip_of_true_radii(blocks.slip, epsilon, blocks.definition)
    np.testing.assert_allclose(found.slip, slip, atol=1e-12)
    np.testing.assert_allclose(found.normal_force, load, rtol=1e-3)
    inverted = measured.traction_force / (1 + gain) + resistance * load
    np.testing.assert_allclose(found.traction_force, inverted, atol=5e-3)
    np.testing.assert_allclose(rest, 0.0, atol=2e-3)
    more = replace(measured, traction_force=measured.traction_force + 1.0)
    raised = corrected_blocks(more, THESIS_LAW, known(noise=1e-9), zeros=False).traction_force
    np.testing.assert_allclose(raised - found.traction_force, 1 / (1 + gain))


def test_corrected_points_scatter_about_the_true_curve_by_the_noise():
    noise, tau = 0.05, 0.3
    measured, found, rest = corrected(layout(60, 20), noise=noise, rho=0.5, tau=tau)
    assert abs(rest.mean()) < 0.02
    assert 0.8 * noise < rest.std() < 1.1 * noise
    law = THESIS_LAW.force(measured.slip, measured.normal_force, THESIS_VALUES)
    as_measured = measured.traction_force - law
    assert abs(as_measured.mean()) > 0.2
    assert as_measured.std() > 0.8 * tau
    of_runs = found.run_mean(rest)
    assert of_runs.std() < 0.2 * measured.run_mean(as_measured).std()


def test_what_is_left_over_is_that_of_the_law_and_a_run_may_keep_its_zero():
    _, found, rest = corrected(layout(60, 20), noise=1e-3, tau=0.3, zeros=False)
    of_runs = found.run_mean(rest)
    assert of_runs.std() == pytest.approx(rest.std(), rel=1e-3)
    assert rest.std() == pytest.approx(0.3 / (1 + RIG[0]), rel=0.25)


def test_blocks_whose_slip_wanders_lie_on_the_curve_and_not_below_its_peak():
    blocks = replace(layout(40, 10, wander=0.02), slip=np.full(400, THESIS_LAW.peak_slip(
        10.0, THESIS_VALUES)), normal_force=np.full(400, 10.0))  # fmt: skip
    measured, _, rest = corrected(blocks, noise=0.02, tau=0.1)
    assert abs(rest.mean()) < 0.02
    assert measured.traction_force.mean() < THESIS_LAW.force(
        blocks.slip[0], 10.0, THESIS_VALUES) - 0.1  # fmt: skip
