# SPDX-License-Identifier: MIT
"""Small layouts of studies."""

import numpy as np

from model.bayes.blocks import SlipBlocks
from model.bayes.posterior import LoadCell
from model.bayes.rig_errors import RigErrors
from model.slip.coulomb import CoulombStribeck
from model.slip.definition import SlipDefinition
from model.study.design import StudyDesign, study_design

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
    )


def design(blocks=None, law=LAW) -> StudyDesign:
    """Return the design of a small study."""
    return study_design(
        layout() if blocks is None else blocks,
        law,
        load_cell=LoadCell(zero_stability=0.1),
        rig_errors=RigErrors(0.003, 0.02),
    )
