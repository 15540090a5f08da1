# SPDX-License-Identifier: MIT
"""Faults of single samples are found, and noise is none."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.raw import (
    clipped,
    frozen,
    opposed_runs,
    oscillation,
    outliers,
    raw_residuals,
    reach_of_slip_noise,
)
from model.slip.definition import SlipDefinition
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from support.linearised_fits import linearised, scaled, sound_sweep, unchanged, with_force

RNG = np.random.default_rng(1)


def leaps(change=unchanged):
    _, fit, samples = linearised(change)
    residual, _ = raw_residuals(samples, THESIS_LAW, fit.values)
    return outliers(samples, residual, reach_of_slip_noise(samples, THESIS_LAW, fit.values))


def test_noise_is_no_outlier_and_a_few_spikes_are_counted():
    assert leaps().count == 0
    hit = RNG.random(len(sound_sweep().samples)) < 0.01
    found = leaps(with_force(lambda s: 3.0 * hit))
    assert found.count == pytest.approx(hit.sum(), rel=0.3)
    assert found.size == pytest.approx(3.0, rel=0.3)
    worst = np.bincount(sound_sweep().samples.run, hit)
    assert worst[found.runs[0]] >= 0.5 * worst.max()


@pytest.mark.parametrize("far", [(), (7, 20)])
def test_rows_of_a_table_are_far_from_a_curve_and_not_from_their_neighbours(far):
    n, noise = 40, RNG.normal(0, 0.05, 40)
    table = SlipSamples(
        np.linspace(0.01, 0.4, n), np.full(n, 8.0), np.ones(n), np.arange(n),
        tuple(map(str, range(n))), SlipDefinition.MATERIAL,
    )  # fmt: skip
    found = outliers(table, noise + 1.5 * np.isin(np.arange(n), far), np.zeros(n))
    assert found.runs == far


def test_noise_that_carries_slip_over_the_peak_of_a_light_load_is_no_outlier():
    rng, n = np.random.default_rng(3), 20_000
    values = np.concatenate([THESIS_VALUES, np.zeros(12)])
    swing = 0.005 * (1 + np.sin(np.arange(n) / 3.0))  # of the discs; the peak is at 0.014
    slip = np.where(np.arange(n) < n // 5, swing, 0.2)  # most of the sweep is far from it
    exact = SlipSamples(
        slip, np.full(n, 2.13), np.zeros(n), np.zeros(n, np.intp), ("light",),
        SlipDefinition.MATERIAL,
    )  # fmt: skip
    force = -raw_residuals(exact, THESIS_LAW, values)[0] + rng.normal(0, 0.01, n)
    seen = replace(exact, slip=slip + rng.normal(0, 0.0055, n), traction_force=force)
    residual, slope = raw_residuals(seen, THESIS_LAW, values)
    assert not outliers(seen, residual, reach_of_slip_noise(seen, THESIS_LAW, values)).count
    by_slope = 4.5 * 0.0055 * np.abs(slope)  # zero at the peak
    assert outliers(seen, residual, by_slope).count


def test_a_force_that_stops_at_a_limit_is_clipped_and_counts_are_not():
    force = sound_sweep().samples.traction_force
    assert clipped(force) is None
    assert clipped(np.round(force, 1)) is None
    for limit, stopped in ((3.0, np.minimum(force, 3.0)), (-3.0, np.maximum(force, -3.0))):
        found = clipped(stopped)
        assert found is not None
        assert (found.limit, found.count) == (limit, int((stopped == limit).sum()))


@pytest.mark.parametrize(("at_limit", "is_found"), [(3, False), (5, True)])
def test_a_few_equal_maxima_of_a_small_table_are_a_limit(at_limit, is_found):
    table = np.append(np.sort(RNG.random(40)), np.full(at_limit, 1.2))
    assert (clipped(table) is not None) == is_found


def test_frozen_samples_are_told_from_repeats_of_a_coarse_converter():
    force, run = sound_sweep().samples.traction_force, sound_sweep().samples.run
    assert frozen(force, run) == 0
    assert frozen(np.round(force, 0), run) == 0
    held = force.copy()
    starts = np.arange(100, len(held), 1000)
    for start in starts:
        held[start : start + 50] = held[start]
    share = len(starts) * 50 / len(held)
    assert frozen(held, run) == pytest.approx(share, rel=0.15)
    assert frozen(np.round(held, 2), run) == pytest.approx(share, rel=0.3)


TIME = sound_sweep().samples.time
WAVE = np.sin(2 * np.pi * 7.0 * TIME)


def run_out(samples):
    """Let the true slip, and with it the force, swing at 7 Hz, unseen by the measured slip."""
    sweep = sound_sweep()
    swung = THESIS_LAW.force(sweep.slip_true + 0.01 * WAVE, sweep.load_true, THESIS_VALUES)
    before = THESIS_LAW.force(sweep.slip_true, sweep.load_true, THESIS_VALUES)
    return replace(samples, traction_force=samples.traction_force + swung - before)


def hunting(samples):
    return replace(samples, slip=samples.slip + 0.01 * WAVE)


@pytest.mark.parametrize(
    ("change", "in_slip"),
    [(scaled(lambda _: 1 + 0.3 * WAVE), False), (run_out, True), (hunting, True)],
    ids=["force", "true slip", "measured slip"],
)
def test_an_oscillation_of_the_force_is_told_from_one_of_the_slip(change, in_slip):
    _, fit, samples = linearised(change)
    found = oscillation(samples, *raw_residuals(samples, THESIS_LAW, fit.values))
    assert found is not None
    assert found.frequency == pytest.approx(7.0, abs=0.3)
    assert found.in_slip == in_slip
    if not in_slip:
        assert found.amplitude == pytest.approx(0.3, rel=0.25)


def test_noise_of_any_memory_does_not_oscillate():
    _, fit, samples = linearised()
    assert oscillation(samples, *raw_residuals(samples, THESIS_LAW, fit.values)) is None


def test_a_run_whose_traction_opposes_its_slip_is_found_and_zero_errors_are_none():
    samples = sound_sweep().samples
    turned = np.where(samples.run == 11, -1, 1) * samples.traction_force
    assert np.flatnonzero(opposed_runs(replace(samples, traction_force=turned))).tolist() == [11]
    shifted = replace(
        samples, slip=samples.slip - 0.012, traction_force=samples.traction_force + 0.3
    )
    assert not opposed_runs(samples).any()
    assert not opposed_runs(shifted).any()
