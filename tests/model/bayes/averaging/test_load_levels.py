# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.averaging.load_levels import (
    largest_slips,
    load_levels,
    middle_loads,
    nearest_level,
)
from model.slip import SlipDefinition

SIZE = 6


def blocks(slips, loads, rng, *, size=SIZE, repeats=1):
    """Return blocks with slip errors and wander, a run a set-point, no traction yet."""
    load, slip = (np.tile(a.ravel(), repeats) for a in np.meshgrid(loads, slips, indexing="ij"))
    n_runs, n = len(slip), len(slip) * size
    run = np.repeat(np.arange(n_runs), size)
    return SlipBlocks(
        slip=slip[run] + 0.003 * rng.standard_normal(n),
        normal_force=load[run] * rng.uniform(0.98, 1.1, n),
        traction_force=np.zeros(n),
        count=np.full(n, 10),
        run=run,
        run_names=tuple(map(str, range(n_runs))),
        definition=SlipDefinition.MATERIAL,
        slip_wander=np.full(n, 4e-6),
        slip_error=np.full(n, 1e-6),
        load_variance=np.zeros(n),
        load_skewness=np.zeros(n),
        slip_load_covariance=np.zeros(n),
        run_slip_error=np.full(n_runs, 5e-7),
        load_error=np.zeros(n),
        noise_size=np.ones(n),
    )


@given(order=st.permutations([2.13, 6.63, 8.13, 12.75]))
def test_the_loads_that_were_set_are_found_whatever_their_order(order):
    data = blocks(np.linspace(0, 1, 10), np.array(order), np.random.default_rng(5))
    found = load_levels(data)
    np.testing.assert_allclose(found, [2.13, 6.63, 8.13, 12.75], rtol=0.1)


def test_a_tested_load_is_the_middle_of_its_blocks_and_not_their_lower_quartile():
    rng = np.random.default_rng(8)
    data = blocks(np.linspace(0.01, 0.5, 24), np.array([3.0, 12.0]), rng)
    load = np.where(data.normal_force > 6, 12.0, 3.0)
    data = replace(data, normal_force=load * rng.uniform(0.96, 1.04, len(load)))
    np.testing.assert_allclose(middle_loads(data), [3.0, 12.0], rtol=0.01)
    assert np.all(load_levels(data) < 0.99 * np.array([3.0, 12.0]))  # lower quartiles


def test_a_swept_load_is_stood_for_by_quantiles():
    data = blocks(np.array([0.1]), np.geomspace(1.0, 100.0, 25), np.random.default_rng(6))
    found = load_levels(data)
    assert len(found) == 8
    assert np.all(np.diff(found) > 0)
    np.testing.assert_allclose(
        np.mean(data.normal_force <= found[:, None], axis=1), (np.arange(8) + 0.5) / 8, atol=0.01
    )


def test_the_nearest_level_is_the_nearest_in_ratio():
    nearest = nearest_level(np.array([1.0, 9.0, 11.0, 99.0]), np.array([1.0, 10.0, 12.0]))
    assert nearest.tolist() == [0, 1, 2, 2]
    assert nearest_level(np.array([3.5]), np.array([2.0, 6.0])).tolist() == [1]  # √12 is the middle


def test_the_largest_slip_of_each_load_is_taken_in_size_and_by_itself():
    rng = np.random.default_rng(7)
    light = blocks(np.linspace(-0.6, 0.2, 9), np.array([2.0]), rng)
    heavy = blocks(np.linspace(-0.1, 0.3, 9), np.array([10.0]), rng)
    both = replace(
        light,
        slip=np.concatenate([light.slip, heavy.slip]),
        normal_force=np.concatenate([light.normal_force, heavy.normal_force]),
        run=np.concatenate([light.run, heavy.run + light.n_runs]),
        run_names=light.run_names + heavy.run_names,
    )
    np.testing.assert_allclose(largest_slips(both), [0.6, 0.3], atol=0.02)
