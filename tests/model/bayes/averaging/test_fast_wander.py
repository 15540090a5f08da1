# SPDX-License-Identifier: MIT
"""The force tells noise of the speeds from wander of slip that is as fast."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.averaging.blocks import block_means
from model.bayes.averaging.fast_wander import FastWander, fast_wander
from model.bayes.checks.raw import raw_residuals
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep

SLIP = 0.01
PLAN = SweepPlan(slips=tuple(np.linspace(-0.3, 0.3, 31).tolist()), loads=(6.0, 12.0))
NO_ERRORS = np.zeros(12)


def swept(*, noise: float = 0.0, wander: float = 0.0, wander_time: float = 0.0, seed: int = 0,
          **changes):  # fmt: skip
    ground = PLAN.speed_leg / PLAN.radius_ground
    rig = replace(
        TYPICAL_RIG, speed_noise=float(noise / np.hypot(1 / PLAN.omega_leg, 1 / ground)),
        slip_wander_sd=wander, slip_wander_time=wander_time, **changes,
    )  # fmt: skip
    rng = np.random.default_rng(seed)
    return simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=PLAN, imperfections=rig, rng=rng
    ).samples  # fmt: skip


def told(samples) -> FastWander:
    values = np.concatenate([THESIS_VALUES, NO_ERRORS])
    found = fast_wander(samples, *raw_residuals(samples, THESIS_LAW, values))
    assert found is not None
    return found


CASES = {
    "noise": (swept(noise=SLIP), 0.0),
    "noise and slow wander": (swept(noise=SLIP, wander=SLIP, wander_time=0.05), 0.0),
    "wander within a sample": (swept(wander=SLIP), 1.0),
    "half and half": (swept(noise=SLIP, wander=SLIP), 0.5),
    "half and half, forces 3 ms late": (swept(noise=SLIP, wander=SLIP, delay=0.003), 0.5),
}


@pytest.mark.parametrize("case", CASES)
def test_the_share_of_wander_is_found_within_its_error(case):
    samples, truth = CASES[case]
    found = told(samples)
    assert abs(found.share - truth) < 3.5 * max(found.sd, 0.01)
    assert found.sd < 0.15


def test_wander_is_used_only_beyond_chance():
    assert told(CASES["noise"][0]).used == 0.0
    assert 0.3 < told(CASES["half and half"][0]).used < 0.7
    assert FastWander(1.2, 0.1).used == 1.0
    assert FastWander(0.25, 0.1).used == 0.0


def test_slip_without_noise_has_nothing_to_tell():
    samples = swept()
    flat = np.zeros(len(samples))
    assert fast_wander(replace(samples, slip=flat), flat, flat + 1.0) is None
    assert fast_wander(CASES["noise"][0], flat, flat) is None


def test_wander_spreads_slip_within_blocks_instead_of_erring_between_them():
    samples, _ = CASES["half and half"]
    noise, wander = (block_means(samples, 20, wander_share=share) for share in (0.0, 1.0))
    assert np.all(wander.slip_error <= noise.slip_error)
    assert not wander.run_slip_error.any()
    assert np.mean(wander.slip_wander) == pytest.approx(2 * SLIP**2, rel=0.15)
    assert np.mean(noise.slip_wander) < 0.2 * SLIP**2
    np.testing.assert_array_equal(noise.count, wander.count)
