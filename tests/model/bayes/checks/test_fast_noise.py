# SPDX-License-Identifier: MIT
"""Noise that may be fast wander is tested where it matters, and both extremes are reported."""

from dataclasses import replace

import numpy as np

from model.bayes.averaging.fast_wander import FastWander
from model.bayes.checks.check import Check
from model.bayes.checks.fast_noise import fast_noise
from model.bayes.checks.raw import raw_residuals
from support.linearised_fits import CHOICE, linearised, unchanged


def check_on(change=unchanged, choice=CHOICE) -> list[Check]:
    posterior, fit, samples = linearised(change, choice=choice)
    residual, slope = raw_residuals(samples, posterior.law, fit.values)
    return fast_noise(posterior, fit, samples, choice, residual, slope)


def noisy(samples):
    """Add noise of 0.01 to the measured slip: it is in no force."""
    noise = np.random.default_rng(1).normal(0, 0.01, len(samples))
    return replace(samples, slip=samples.slip + noise)


def hidden(samples):
    """Add a large white noise to the traction, too, behind which no fast wander is seen."""
    noise = np.random.default_rng(2).normal(0, 3.0, len(samples))
    samples = noisy(samples)
    return replace(samples, traction_force=samples.traction_force + noise)


def test_noise_that_force_does_not_follow_passes_with_both_extremes():
    (check,) = check_on()
    assert check.passed
    assert "noise alone, or wander alone: K 20.4 or 2" in check.evidence


def test_noise_behind_which_wander_could_hide_is_not_testable():
    (check,) = check_on(hidden)
    assert check.untested == "noise or fast wander of slip"
    assert "noise alone, or wander alone: K " in check.evidence


def test_a_share_that_the_forces_contradict_fails():
    (check,) = check_on(choice=replace(CHOICE, wander=FastWander(1.0, 0.01)))
    assert check.failed
    assert "100% is taken for wander" in check.evidence


def test_slip_without_noise_is_not_checked():
    assert check_on(lambda s: replace(s, slip=np.round(s.slip, 1))) == []
