# SPDX-License-Identifier: MIT
"""From samples to a calibration: where the sampler is judged, and how it is stopped."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.calibrate import (
    CHUNK,
    FitStopped,
    SamplerSettings,
    calibrate,
    next_look,
)
from model.bayes.posterior import LoadCell
from model.errors import FitError
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.quick_fits import FEW, NO_PRIOR_STARTS
from support.simulated_sweep import simulate_sweep


class Watcher:
    """Notes the steps and asks to stop at one of its looks."""

    def __init__(self, stop_at=None):
        self.steps, self.looks, self.stop_at = [], 0, stop_at

    def step(self, what, fraction):
        self.steps.append(what)

    def stop_requested(self):
        self.looks += 1
        return self.looks == self.stop_at


@pytest.fixture(scope="module")
def samples():
    plan = SweepPlan(slips=tuple(np.linspace(0.005, 0.3, 8)), loads=(4.0, 12.0), rate=40.0)
    rng = np.random.default_rng(2)
    return simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG, rng=rng
    ).samples


def fitted(samples, watcher, **options):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(*NO_PRIOR_STARTS)
        for name, value in FEW.items():
            patch.setattr(f"model.bayes.calibrate.{name}", value)
        return calibrate(
            samples, {"thesis": THESIS_LAW}, load_cell=LoadCell(),
            settings=SamplerSettings(ensembles=2, max_steps=100, block_length=10, threads=1),
            source="sim:test", watcher=watcher, clock=lambda: 0.0, **options,
        )  # fmt: skip


@pytest.fixture(scope="module")
def uninterrupted(samples):
    """Return a fit that nothing stopped, its chains, and these as they were handed out."""
    kept = []
    return *fitted(samples, Watcher(), keep=kept.append), kept


@pytest.mark.long
def test_a_fit_that_was_stopped_goes_on_to_the_same_calibration(samples, uninterrupted):
    whole, chains, _ = uninterrupted
    with pytest.raises(FitStopped) as stopped:
        fitted(samples, Watcher(stop_at=4))
    assert 1 < stopped.value.chains.n_steps < chains.n_steps
    resumed, _ = fitted(samples, Watcher(), earlier=stopped.value.chains)
    np.testing.assert_array_equal(resumed.draws.flat, whole.draws.flat)
    assert [e.mean for e in resumed.parameters] == [e.mean for e in whole.parameters]
    assert whole.comparison is None


def test_chains_of_another_posterior_are_not_gone_on_from(samples, uninterrupted):
    chains = uninterrupted[1]
    for wrong in (
        replace(chains, log_density=chains.log_density + 0.1),
        replace(chains, z=chains.z[..., 1:]),
    ):
        with pytest.raises(FitError, match=r"another posterior.*without --resume"):
            fitted(samples, Watcher(), earlier=wrong)


def test_a_fit_stopped_before_sampling_has_no_chains(samples):
    with pytest.raises(FitStopped) as stopped:
        fitted(samples, Watcher(stop_at=1))
    assert stopped.value.chains is None


def test_chains_are_handed_out_as_they_grow(uninterrupted):
    lengths = [chains.n_steps for chains in uninterrupted[2]]
    assert lengths == sorted(set(lengths))
    assert lengths[-1] >= FEW["FIRST_LOOK"]


@pytest.mark.parametrize("n_steps", range(1, 400, 20))
def test_resumed_fit_is_judged_where_the_uninterrupted_one_is(n_steps):
    def judged(first: int) -> list[int]:
        found, look = [], next_look(first - CHUNK + 1)
        for n in range(first, 1000, CHUNK):
            if n >= look:
                found.append(n)
                look = next_look(n + 1)
        return found

    assert judged(n_steps) == [n for n in judged(1) if n >= n_steps]
