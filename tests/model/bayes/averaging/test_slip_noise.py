# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.bayes.averaging.slip_noise import noise_and_freedom, slip_noise_variance
from support.slip_runs import samples, wander, white

NOISE = 0.01


@pytest.mark.parametrize("trend", [0.0, 0.3], ids=["held", "swept"])
@pytest.mark.parametrize("wandering", [0.0, 0.01], ids=["steady", "wandering"])
def test_white_slip_noise_is_recovered_whatever_the_slip_does(trend, wandering):
    rng = np.random.default_rng(4)
    true = trend * np.abs(np.linspace(-1, 1, 250)) + wander(rng, (40, 250), wandering, steps=60)
    found = slip_noise_variance(samples(true + white(rng, true.shape, NOISE)))
    assert found.mean() == pytest.approx(NOISE**2, rel=0.1)


def test_the_noise_of_many_short_runs_is_not_underrated():
    rng = np.random.default_rng(0)
    found = slip_noise_variance(samples(white(rng, (1000, 12), NOISE)))
    assert 0.95 < found.mean() / NOISE**2 < 1.25  # estimates of 12 samples are skewed


def test_wander_is_not_mistaken_for_noise():
    rng = np.random.default_rng(5)
    data = samples(wander(rng, (40, 250), NOISE, steps=40))
    assert slip_noise_variance(data).mean() < 0.01 * NOISE**2


def test_runs_may_have_sensors_of_different_noise():
    rng = np.random.default_rng(9)
    sizes = np.repeat([0.002, 0.02], 20)[:, None]
    found = slip_noise_variance(samples(sizes * rng.standard_normal((40, 1000))))
    np.testing.assert_allclose(found[:20].mean(), 0.002**2, rtol=0.5)
    np.testing.assert_allclose(found[20:].mean(), 0.02**2, rtol=0.1)


def test_runs_too_short_to_judge_take_the_others_noise():
    rng = np.random.default_rng(10)
    long = [white(rng, 300, NOISE) for _ in range(10)]
    found = slip_noise_variance(samples([*long, white(rng, 5, NOISE)]))
    assert found[-1] == pytest.approx(np.median(found[:-1]), rel=0.02)


@pytest.mark.parametrize("runs", [1, 40], ids=["one run", "runs alike"])
def test_the_scatter_of_noise_estimates_is_that_of_their_degrees_of_freedom(runs):
    rng = np.random.default_rng(14)
    found = [noise_and_freedom(samples(white(rng, (runs, 100), NOISE))) for _ in range(200)]
    scatter = np.var([noise[0] for noise, _ in found]) / NOISE**4
    claimed = np.mean([2 / freedom[0] for _, freedom in found])
    assert scatter == pytest.approx(claimed, rel=0.6)  # a median scatters by half more than a mean
