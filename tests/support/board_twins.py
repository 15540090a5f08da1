# SPDX-License-Identifier: MIT
"""A board that reads the slip rig, and its twin, on a clock that tests set."""

import numpy as np

from rig.clock import ManualClock
from rig.links.memory import MemoryLink
from rig.slip_rig.board import RigBoard
from rig.slip_rig.imperfections import RigImperfections
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import TWIN_LAWS, RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan

PROFILE = load_rig_profile("rig-board-serial")


PERFECT = RigImperfections()


def world(law="magic-formula", *, plan=None, imperfections=PERFECT, dynamics=None, seed=0):
    return SimulatedRig(
        *TWIN_LAWS[law],
        plan=plan or SweepPlan(),
        imperfections=imperfections,
        dynamics=dynamics or RigDynamics(),
        rng=np.random.default_rng(seed),
    )


def board(rig, **options):
    clock = ManualClock()
    twin = SimulatedBoard(rig, profile=PROFILE.board, rng=np.random.default_rng(0), **options)
    stream = RigBoard(
        MemoryLink(twin, clock=clock), profile=PROFILE.board, limits=PROFILE.limits, clock=clock
    )
    return stream, clock
