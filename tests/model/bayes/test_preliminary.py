# SPDX-License-Identifier: MIT
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.signal import lfilter

from model.bayes.averaging.blocks import block_means
from model.bayes.plain.fit import plain_fit
from model.bayes.posterior import LoadCell, default_priors
from model.bayes.preliminary import (
    MAX_BLOCKS,
    MAX_SLIP_SPREAD,
    MEMORIES,
    MIN_BLOCKS_PER_RUN,
    choose_block_length,
    correlation_time,
)
from model.slip import SlipDefinition
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import RigImperfections
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep

PERFECT = RigImperfections()
PLAN = SweepPlan(slips=tuple(np.linspace(0, 0.8, 20)), loads=(2.13, 12.75), duration=0.8)
SLIP_SCALE = THESIS_VALUES[2] / THESIS_VALUES[0]


def sweep(imperfections, *, plan=PLAN, seed=0):
    rng = np.random.default_rng(seed)
    log = simulate_sweep(THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=imperfections, rng=rng)
    return log.samples


def priors_of(samples):
    return default_priors(THESIS_LAW, block_means(samples, 10), LoadCell())


def choice(samples):
    plain = plain_fit(
        samples, THESIS_LAW, priors=priors_of(samples), zero_sd=0.003,
        rng=np.random.default_rng(0),
    )  # fmt: skip
    return choose_block_length(samples, plain)


def ar1(rho, shape, seed=0):
    shock = np.random.default_rng(seed).standard_normal(shape)
    shock[:, 1:] *= np.sqrt(1 - rho**2)
    return lfilter([1.0], [1.0, -rho], shock, axis=1)


# --- correlation time


def time_of(residual, slices, *, white=0.0):
    return correlation_time(residual, slices, white=np.full(len(residual), white))


@pytest.mark.parametrize("rho", [0.5, 0.9, 0.97])
def test_correlation_time_of_an_ar1_is_the_known_one(rho):
    paths = ar1(rho, (20, 5000))
    slices = [slice(5000 * run, 5000 * (run + 1)) for run in range(20)]
    found = time_of(paths.ravel(), slices)
    assert found == pytest.approx((1 + rho) / (1 - rho), rel=0.1)


def test_run_offsets_are_no_memory():
    slices = [slice(1000 * run, 1000 * (run + 1)) for run in range(20)]
    paths = ar1(0.5, (20, 1000))
    offset = 100 * np.random.default_rng(1).standard_normal((20, 1))
    found = [time_of(x.ravel(), slices) for x in (paths, paths + offset)]
    assert found[1] == pytest.approx(found[0], rel=1e-9)


def test_runs_of_different_length_pool_their_correlation():
    lengths = [400, 20_000, 50, 40_000]
    edges = np.append(0, np.cumsum(lengths))
    paths = np.concatenate([ar1(0.8, (1, n), seed=n)[0] for n in lengths])
    slices = [slice(a, b) for a, b in pairwise(edges)]
    assert time_of(paths, slices) == pytest.approx(9.0, rel=0.15)


def test_residuals_of_nothing_have_the_shortest_time():
    assert time_of(np.zeros(10), [slice(0, 5), slice(5, 10)]) == 1.0


def test_known_white_noise_hides_no_memory():
    slices = [slice(5000 * run, 5000 * (run + 1)) for run in range(20)]
    paths = ar1(0.9, (20, 5000))
    noise = np.random.default_rng(2).standard_normal(paths.shape)
    hidden = (paths + noise).ravel()
    assert time_of(hidden, slices) == pytest.approx(10.0, rel=0.1)  # half of 19, and half of 1
    assert time_of(hidden, slices, white=1.0) == pytest.approx(19.0, rel=0.1)


def test_a_few_noisy_runs_outweigh_no_others():
    slices = [slice(5000 * run, 5000 * (run + 1)) for run in range(20)]
    paths = ar1(0.9, (20, 5000))
    loud = np.random.default_rng(3).standard_normal((2, 5000)) * 30.0
    white = np.zeros(paths.shape)
    paths[:2] += loud
    white[:2] = 900.0
    found = correlation_time(paths.ravel(), slices, white=white.ravel())
    assert found == pytest.approx(19.0, rel=0.15)


# --- block length


def blocks_a_run(samples, length):
    return np.bincount(block_means(samples, length).run).min()


def test_blocks_last_as_long_as_the_noise_remembers():
    rig = replace(PERFECT, noise_sd0=0.05, noise_correlation_time=0.05)
    plan = replace(PLAN, slips=PLAN.slips[::2], duration=8.0)
    chosen = choice(sweep(rig, plan=plan))
    rho = np.exp(-0.004 / 0.05)
    # With each run's mean goes some of its memory: an eighth of it in runs 80 times as long.
    assert chosen.correlation == pytest.approx((1 + rho) / (1 - rho), rel=0.15)
    assert chosen.length == int(np.ceil(MEMORIES * chosen.correlation))
    assert chosen.reason == "twice the correlation time of the noise"


@pytest.mark.parametrize("time", [0.2, 2.0])
def test_however_long_the_memory_a_run_keeps_five_blocks(time):
    samples = sweep(replace(PERFECT, noise_sd0=0.05, noise_correlation_time=time))
    assert blocks_a_run(samples, choice(samples).length) >= MIN_BLOCKS_PER_RUN


def test_however_noisy_the_slip_sensors_a_run_keeps_five_blocks():
    samples = sweep(replace(PERFECT, noise_sd0=0.05, speed_noise=0.1))
    chosen = choice(samples)
    assert chosen.length == PLAN.n_samples // MIN_BLOCKS_PER_RUN
    assert blocks_a_run(samples, chosen.length) == MIN_BLOCKS_PER_RUN
    assert chosen.reason == "at least 5 blocks a run"


def test_noisy_slip_sensors_ask_for_longer_blocks():
    quiet = replace(PERFECT, noise_sd0=0.05)
    noisy = replace(quiet, speed_noise=0.02)
    chosen = choice(sweep(noisy))
    assert chosen.length > choice(sweep(quiet)).length
    noise = (0.02 / 12) ** 2 * (3.43**2 + 0.5)
    assert chosen.reason == "to average out the slip sensors' noise"
    assert chosen.length == pytest.approx(noise / (SLIP_SCALE / 10) ** 2, rel=0.3)


def test_there_are_never_more_blocks_than_the_limit():
    plan = replace(PLAN, rate=1000.0)
    samples = sweep(replace(PERFECT, noise_sd0=0.05), plan=plan)
    chosen = choice(samples)
    assert len(block_means(samples, chosen.length)) <= MAX_BLOCKS
    assert chosen.reason == f"at most {MAX_BLOCKS} blocks"


def swept(seconds, *, rate=500, correlation=0.98):
    """Return samples of runs that sweep slip from -0.3 to 0.3 under slowly forgetting noise."""
    n = int(seconds * rate)
    slip = np.tile(np.linspace(-0.3, 0.3, n), 4)
    load = np.repeat([3.0, 6.0, 9.0, 12.0], n)
    noise = 0.05 * ar1(correlation, (4, n)).ravel()
    return SlipSamples(
        slip=slip,
        normal_force=load,
        traction_force=THESIS_LAW.force(slip, load, THESIS_VALUES) + noise,
        run=np.repeat(np.arange(4), n),
        run_names=("a", "b", "c", "d"),
        definition=SlipDefinition.MATERIAL,
    )


@pytest.mark.parametrize(
    ("seconds", "reason"),
    [
        (1.0, "so that slip changes little within a block"),
        (5.0, "so that averaging hardly moves the plain fit"),
    ],
)
def test_a_fast_sweep_of_slip_shortens_the_blocks_to_its_pace(seconds, reason):
    samples = swept(seconds)
    chosen = choice(samples)
    spread = np.sqrt(block_means(samples, chosen.length).slip_wander)
    assert np.quantile(spread, 0.9) <= MAX_SLIP_SPREAD * SLIP_SCALE * 1.1
    assert chosen.reason == reason
    assert chosen.length < MEMORIES * chosen.correlation


def test_a_slow_sweep_keeps_the_blocks_the_noise_asks_for():
    chosen = choice(swept(20.0, correlation=0.8))
    assert chosen.reason == "twice the correlation time of the noise"
    assert chosen.length == int(np.ceil(MEMORIES * chosen.correlation))


def test_three_samples_a_run_are_still_blocks():
    chosen = choice(sweep(replace(PERFECT, noise_sd0=0.05), plan=replace(PLAN, duration=0.012)))
    assert chosen.length == 1
