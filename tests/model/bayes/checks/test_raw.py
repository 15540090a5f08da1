# SPDX-License-Identifier: MIT
"""Faults of single samples are found, and noise is none."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.checks.raw import clipped, delay, opposed_runs, outliers, raw_residuals
from model.slip.thesis import THESIS_LAW
from support.linearised_fits import linearised, sound_sweep, with_force

RNG = np.random.default_rng(1)


def raw(change=None):
    _, fit, samples = linearised(*([change] if change else []))
    return samples, *raw_residuals(samples, THESIS_LAW, fit.values)


def late(steps):
    def change(samples):
        force = samples.traction_force.copy()
        for part in samples.slices():
            force[part] = np.append(np.full(steps, force[part][0]), force[part][:-steps])
        return replace(samples, traction_force=force)

    return change


def test_noise_is_no_outlier_and_a_few_spikes_are_counted():
    assert not outliers(*raw()).matter
    hit = RNG.random(len(sound_sweep().samples)) < 0.004
    found = outliers(*raw(with_force(lambda s: 3.0 * hit)))
    assert found.matter
    assert found.count == pytest.approx(hit.sum(), rel=0.3)
    assert found.size == pytest.approx(3.0, rel=0.3)


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
