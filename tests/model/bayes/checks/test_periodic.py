# SPDX-License-Identifier: MIT
"""A swing of slip with the angle of a disc is found with its period."""

import numpy as np
import pytest

from model.bayes.checks.periodic import block_times, find_swing
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from support.linearised_fits import linearised, sound_sweep, with_force

OMEGA = 12.0  # of the leg disc [rad/s]


def run_out(amplitude):
    sweep = sound_sweep()
    slip, load = sweep.slip_true, sweep.load_true
    swing = amplitude * (1 - slip) * np.sin(OMEGA * np.asarray(sweep.table["t"]))
    before = THESIS_LAW.force(slip, load, THESIS_VALUES)
    return with_force(lambda _: THESIS_LAW.force(slip + swing, load, THESIS_VALUES) - before)


def swing_of(change=None):
    _, fit, samples = linearised(*([change] if change else []))
    found = find_swing(fit, block_times(fit, samples))
    assert found is not None
    return found


def test_run_out_of_a_disc_is_found_with_its_period():
    found = swing_of(run_out(0.006))
    assert found.p < 1e-6
    assert found.period == pytest.approx(2 * np.pi / OMEGA, rel=0.2)
    assert 0.002 < found.slip < 0.012


def test_a_true_disc_does_not_swing():
    assert swing_of().p > 1e-3
