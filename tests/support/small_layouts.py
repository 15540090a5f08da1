# SPDX-License-Identifier: MIT
"""Blocks of small experiments, and their posterior density."""

import numpy as np

from model.bayes.averaging.blocks import SlipBlocks
from model.bayes.fit import not_identified
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.slip.coulomb import CoulombStribeck
from model.slip.definition import SlipDefinition
from model.slip.rig_errors import RigErrors

LAW = CoulombStribeck(stribeck=False)


def layout(n_runs=12, blocks_a_run=3, *, wander=0.0, error=0.0, load_sd=0.0, skewness=0.0):
    """Return blocks of runs at slips on both sides and two loads, without traction."""
    n = n_runs * blocks_a_run
    run = np.repeat(np.arange(n_runs), blocks_a_run)
    load = np.where(run % 2, 4.0, 10.0)
    return SlipBlocks(
        slip=np.linspace(-0.3, 0.6, n_runs)[run],
        normal_force=load,
        traction_force=np.linspace(-1.0, 4.0, n),
        count=np.full(n, 20),
        run=run,
        run_names=tuple(f"run {i}" for i in range(n_runs)),
        definition=SlipDefinition.MATERIAL,
        slip_wander=np.full(n, wander**2),
        slip_error=np.full(n, error**2),
        load_variance=(load_sd * load) ** 2,
        load_skewness=np.full(n, skewness),
        slip_load_covariance=np.zeros(n),
        run_slip_error=np.full(n_runs, error**2),
        load_error=np.zeros(n),
        noise_size=np.ones(n),
    )


def posterior(blocks=None, law=LAW) -> SlipPosterior:
    """Return the posterior density of a small experiment, with default priors."""
    blocks = layout() if blocks is None else blocks
    priors = default_priors(law, blocks, LoadCell(zero_stability=0.1), RigErrors(0.003, 0.02))
    return SlipPosterior(blocks, law, priors, not_identified(blocks))
