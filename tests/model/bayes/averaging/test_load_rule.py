# SPDX-License-Identifier: MIT
from types import SimpleNamespace

import numpy as np
from scipy.stats import skew

from model.bayes.averaging.load_rule import load_rule


def blocks_of(load, slip):
    """Return the moments of each row of loads and slips that the rule reads."""
    centred = load - load.mean(axis=1, keepdims=True)
    return SimpleNamespace(
        normal_force=load.mean(axis=1),
        slip=slip.mean(axis=1),
        load_variance=load.var(axis=1),
        load_skewness=skew(load, axis=1),
        slip_load_covariance=(centred * slip).mean(axis=1),
    )


def test_two_loads_have_the_mean_variance_and_skewness_of_all():
    rng = np.random.default_rng(4)
    load = 5.0 + rng.gamma(2.0, 0.4, (50, 30)) * rng.choice([-1.0, 1.0], (50, 1))
    blocks = blocks_of(load, np.zeros_like(load))
    rule = load_rule(blocks)
    share = np.stack([1 - rule.heavy_share, rule.heavy_share])
    away = np.stack([rule.light, rule.heavy]) - blocks.normal_force
    np.testing.assert_allclose((share * away).sum(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose((share * away**2).sum(axis=0), blocks.load_variance)
    third = (share * away**3).sum(axis=0) / blocks.load_variance**1.5
    np.testing.assert_allclose(third, blocks.load_skewness, atol=1e-12)


def test_slip_follows_load_by_its_regression():
    rng = np.random.default_rng(5)
    load = rng.uniform(4.0, 6.0, (20, 30))
    rule = load_rule(blocks_of(load, 0.1 + 0.03 * load))
    np.testing.assert_allclose(rule.slip_per_load, 0.03)
    np.testing.assert_allclose(rule.variance, load.var(axis=1))


def test_slip_does_not_follow_a_load_that_hardly_varies():
    rng = np.random.default_rng(6)
    load = 5.0 + 1e-3 * rng.standard_normal((20, 30))
    rule = load_rule(blocks_of(load, 0.1 + 0.03 * (load - 5.0)))
    assert np.all(rule.slip_per_load < 0.03 * (1e-3 / 0.025) ** 2 * 3)


def test_a_single_load_is_spread_by_a_thousandth_so_that_a_slope_in_load_is_defined():
    nothing = np.zeros(1)
    blocks = SimpleNamespace(
        normal_force=np.full(1, 5.0), slip=nothing, load_variance=nothing, load_skewness=nothing,
        slip_load_covariance=nothing,
    )  # fmt: skip
    rule = load_rule(blocks)
    np.testing.assert_allclose(rule.heavy - rule.light, 2 * 0.005)
