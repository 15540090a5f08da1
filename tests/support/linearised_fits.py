# SPDX-License-Identifier: MIT
"""Simulated rigs with one fault, linearised around the truth: no fit is needed to look for it."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np

from model.bayes.averaging.blocks import block_means
from model.bayes.checks.linear import Linearised, linearise
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.preliminary import BlockChoice
from model.slip.samples import SlipSamples
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import SimulatedSweep, simulate_sweep

HALF = (0.01, 0.02, 0.035, 0.06, 0.15, 0.4)
SLIPS = (*(-s for s in HALF[::-1]), *HALF)
MEASURED = {
    "slip_error_scale": 1.0,
    "noise_floor": 0.03,
    "noise_correlation": 0.1,
    "offset_spread": 0.05,
}
CHOICE = BlockChoice(12, 5.0, "as planned")
"""How samples of `linearised` become blocks."""
Change = Callable[[SlipSamples], SlipSamples]


@cache
def sound_sweep() -> SimulatedSweep:
    """Simulate a rig at two loads, each of twelve slips measured twice."""
    plan = SweepPlan(slips=SLIPS * 2, loads=(4.0, 12.0), rate=100.0)
    return simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG,
        rng=np.random.default_rng(7),
    )  # fmt: skip


def unchanged(samples: SlipSamples) -> SlipSamples:
    """Return the samples as they are."""
    return samples


EXACT = {"radius_error": 0.0, "rolling_resistance": 0.0}
"""A rig that is known to have neither error."""


def linearised(
    change: Change = unchanged,
    *,
    fixed: Mapping[str, float] = EXACT,
    found: Mapping[str, float] = EXACT,
    choice: BlockChoice = CHOICE,
) -> tuple[SlipPosterior, Linearised, SlipSamples]:
    """Linearise around the truth, and what was found of the rig, the fit of changed samples."""
    samples = change(sound_sweep().samples)
    blocks = block_means(samples, choice.length, wander_share=choice.wander_share)
    force = np.abs(blocks.run_mean(blocks.traction_force))[blocks.run]
    blocks = replace(blocks, noise_size=1 + force / 3)  # as it is simulated
    posterior = SlipPosterior(
        blocks, THESIS_LAW, default_priors(THESIS_LAW, blocks, LoadCell(zero_stability=0.1)), fixed
    )
    names = [parameter.name for parameter in THESIS_LAW.parameters]
    truth = dict(zip(names, map(float, THESIS_VALUES), strict=True))
    z = posterior.coordinates({**truth, **MEASURED, **found})
    return posterior, linearise(posterior, z[None]), samples


def with_force(change: Callable[[SlipSamples], np.ndarray]) -> Change:
    """Return a change that adds a force to the traction of each sample [N]."""
    return lambda s: replace(s, traction_force=s.traction_force + change(s))
