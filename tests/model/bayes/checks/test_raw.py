# SPDX-License-Identifier: MIT
"""Faults of single samples are found, and noise is none."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.raw import (
    clipped,
    delay,
    opposed_runs,
    outliers,
    raw_residuals,
    reach_of_slip_noise,
)
from model.slip.definition import SlipDefinition
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from support.linearised_fits import linearised, sound_sweep, with_force

RNG = np.random.default_rng(1)


def raw(change=None):
    _, fit, samples = linearised(*([change] if change else []))
    return samples, *raw_residuals(samples, THESIS_LAW, fit.values)


def leaps(change=None):
    _, fit, samples = linearised(*([change] if change else []))
    residual, _ = raw_residuals(samples, THESIS_LAW, fit.values)
    return outliers(samples, residual, reach_of_slip_noise(samples, THESIS_LAW, fit.values))


def late(steps):
    def change(samples):
        force = samples.traction_force.copy()
        for part in samples.slices():
            force[part] = np.append(np.full(steps, force[part][0]), force[part][:-steps])
        return replace(samples, traction_force=force)

    return change


def test_noise_is_no_outlier_and_a_few_spikes_are_counted():
    assert not leaps().matter
    hit = RNG.random(len(sound_sweep().samples)) < 0.004
    found = leaps(with_force(lambda s: 3.0 * hit))
    assert found.matter
    assert found.count == pytest.approx(hit.sum(), rel=0.3)
    assert found.size == pytest.approx(3.0, rel=0.3)


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
    assert not outliers(seen, residual, reach_of_slip_noise(seen, THESIS_LAW, values)).matter
    by_slope = 4.5 * 0.0055 * np.abs(slope)  # zero at the peak
    assert outliers(seen, residual, by_slope).matter


def test_a_force_that_stops_at_a_limit_is_clipped_and_counts_are_not():
    force = sound_sweep().samples.traction_force
    assert clipped(force) is None
    assert clipped(np.round(force, 1)) is None
    found = clipped(np.minimum(force, 3.0))
    assert found is not None
    assert (found.limit, found.count) == (3.0, int((force >= 3.0).sum()))
    low = clipped(np.maximum(force, -3.0))
    assert low is not None
    assert low.limit == -3.0


def test_a_late_force_is_found_by_what_changes_and_a_prompt_one_is_not_late():
    assert min(delay(*raw(), span=span).p for span in (1, 2, 4, 8)) > 1e-3
    behind = [delay(*raw(late(4)), span=span) for span in (1, 2, 4, 8)]
    assert min(each.p for each in behind) < 1e-5
    assert all(each.t > 0 for each in behind)
    assert all(each.steps > 0 for each in behind)


def test_a_run_whose_traction_opposes_its_slip_is_found():
    samples = sound_sweep().samples
    assert not opposed_runs(samples).any()
    turned = np.where(samples.run == 11, -1, 1) * samples.traction_force
    assert np.flatnonzero(opposed_runs(replace(samples, traction_force=turned))).tolist() == [11]


def test_zero_errors_of_slip_or_force_are_no_wrong_sign():
    samples = sound_sweep().samples
    shifted = replace(
        samples, slip=samples.slip - 0.012, traction_force=samples.traction_force + 0.3
    )
    assert not opposed_runs(shifted).any()
