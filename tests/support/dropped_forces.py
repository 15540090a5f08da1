# SPDX-License-Identifier: MIT
"""A simulated sweep whose force falls short now and then, and its posterior on a known rig."""

from dataclasses import replace

import numpy as np

from model.arrays import Array
from model.bayes.blocks import block_means
from model.bayes.laplace import find_mode
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.rig_errors import RigErrors
from model.bayes.samples import SlipSamples
from model.slip import Brush
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep

LAW, TRUTH = Brush(), (20.0, 0.4)
KNOWN = {"slip_stiffness": 20.0, "friction": 0.4, "noise_floor": 0.03}


def simulated(seed: int, dropped: float) -> SlipSamples:
    """Return samples and, for a share of the tenths of a second, a force that falls short."""
    slips = np.tile([0.005, 0.015, 0.03, 0.06, 0.15, 0.4], 3)
    plan = SweepPlan(slips=tuple(slips), loads=(4.0, 12.0), rate=50.0)
    rng = np.random.default_rng(seed)
    samples = simulate_sweep(LAW, TRUTH, plan=plan, imperfections=TYPICAL_RIG, rng=rng).samples
    force = samples.traction_force.copy()
    for start in range(0, len(force), 5):
        if rng.random() < dropped:
            force[start : start + 5] *= rng.uniform(0.0, 0.6)
    return replace(samples, traction_force=force)


def posterior_of(samples: SlipSamples) -> SlipPosterior:
    """Return the posterior on a rig that is well known, so that intervals are narrow."""
    blocks = block_means(samples, 5)
    cell = LoadCell(zero_stability=0.05, gain_sd=0.001, bias_sd=0.01, crosstalk_sd=0.001)
    priors = default_priors(LAW, blocks, cell, RigErrors(0.001, 0.002))
    return SlipPosterior(blocks, LAW, priors)


def deviations(posterior: SlipPosterior) -> Array:
    """Return how far the mode lies from the truth in its standard deviations, K and mu."""
    truth = posterior.coordinates(KNOWN)
    mode = find_mode(posterior.log_density, truth[None])
    return (mode.mode[:2] - truth[:2]) / np.sqrt(np.diag(mode.covariance)[:2])
