# SPDX-License-Identifier: MIT
"""Simulated rigs with one fault, linearised around the truth: no fit is needed to look for it."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np

from model.bayes.averaging.blocks import block_means
from model.bayes.checks.linear import Linearised, linearise
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
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
STABILITY = 0.1  # of the load cell's zero [N]
LENGTH = 12  # samples in a block
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
    length: int = LENGTH,
) -> tuple[SlipPosterior, Linearised, SlipSamples]:
    """Linearise around the truth, and what was found of the rig, the fit of changed samples."""
    samples = change(sound_sweep().samples)
    blocks = block_means(samples, length)
    force = np.abs(blocks.run_mean(blocks.traction_force))[blocks.run]
    blocks = replace(blocks, noise_size=1 + force / 3)  # as it is simulated
    posterior = SlipPosterior(
        blocks, THESIS_LAW, default_priors(THESIS_LAW, blocks, LoadCell(zero_stability=0.1)), fixed
    )
    names = [parameter.name for parameter in THESIS_LAW.parameters]
    truth = dict(zip(names, map(float, THESIS_VALUES), strict=True))
    z = posterior.coordinates({**truth, **MEASURED, **found})
    return posterior, linearise(posterior, z[None], zero_stability=STABILITY), samples


def with_force(change: Callable[[SlipSamples], np.ndarray]) -> Change:
    """Return a change that adds a force to the traction of each sample [N]."""
    return lambda s: replace(s, traction_force=s.traction_force + change(s))


def scaled(factor: Callable[[SlipSamples], np.ndarray]) -> Change:
    """Return a change that multiplies the traction of each sample [-]."""
    return lambda s: replace(s, traction_force=s.traction_force * factor(s))


def only(samples: SlipSamples, runs: np.ndarray) -> SlipSamples:
    """Return some runs of the samples, by their indices in a new order."""
    rows = np.concatenate([np.flatnonzero(samples.run == run) for run in runs])
    return replace(
        samples, slip=samples.slip[rows], normal_force=samples.normal_force[rows],
        traction_force=samples.traction_force[rows], time=samples.time[: len(rows)],
        run=np.repeat(np.arange(len(runs)), np.bincount(samples.run)[runs]),
        run_names=tuple(samples.run_names[run] for run in runs),
    )  # fmt: skip


def swept(late: int = 0, apart: float = 0.0) -> Change:
    """Return a change to runs that sweep slip up and down, traction some samples late.

    Args:
        late: Delay of traction [samples].
        apart: How much less slip the force has while slip rises than while it falls [-].
    """
    rng, n, runs = np.random.default_rng(5), 600, 8
    turns = np.linspace(0, 2 * np.pi, n) * np.where(np.arange(runs) < 4, 1, 3)[:, None]
    slip = 0.2 * np.sin(turns)
    load = np.where(np.arange(runs) % 2, 4.0, 12.0)[:, None]
    seen = np.roll(slip, late, axis=1) - 0.5 * apart * np.sign(np.cos(turns))
    force = THESIS_LAW.force(seen, load, THESIS_VALUES) + 0.05 * rng.standard_normal((runs, 1))
    force += (0.03 + 0.02 * np.abs(force)) * rng.standard_normal(force.shape)
    return lambda s: replace(
        s, slip=slip.ravel(), normal_force=np.repeat(load, n), traction_force=force.ravel(),
        run=np.repeat(np.arange(runs), n), run_names=tuple("abcdefgh"), time=np.arange(n * runs),
    )  # fmt: skip
