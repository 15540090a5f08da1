# SPDX-License-Identifier: MIT
"""Simulated sweeps of discs out of true, whose angles are recorded."""

from dataclasses import replace

import numpy as np

from model.slip.rig_errors import RUN_OUT, RigErrors, radius_ratio_sd, run_out_scatter
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import SimulatedSweep, simulate_sweep

STEEP = SweepPlan(
    slips=tuple(np.linspace(-0.03, 0.06, 10).tolist()), loads=(6.63, 12.75), duration=2.0
)
"""A plan of few runs, most of them on the rise."""
RADII = STEEP.radius_leg, STEEP.radius_ground
ERRORS = RigErrors(radius_ratio_sd(*RADII, 2e-5), 0.002, run_out_scatter(*RADII, RUN_OUT), RUN_OUT)


def swept(leg=RUN_OUT, ground=RUN_OUT, *, seed=0, plan=STEEP) -> SimulatedSweep:
    """Sweep with discs out of true by the same amplitude once and twice a turn."""
    rig = replace(
        TYPICAL_RIG, run_out_leg=leg, run_out_leg_twice=leg, run_out_ground=ground,
        run_out_ground_twice=ground,
    )  # fmt: skip
    return simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=rig,
        rng=np.random.default_rng(seed), angles=True,
    )  # fmt: skip
