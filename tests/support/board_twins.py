# SPDX-License-Identifier: MIT
"""A board that reads the slip rig, and its twin, on a clock that tests set."""

import numpy as np

from model.slip.brush import Brush
from model.slip.coulomb import CoulombStribeck
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.clock import ManualClock
from rig.links.byte_link import MemoryLink
from rig.slip_rig.board import RigBoard
from rig.slip_rig.imperfections import RigImperfections
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan

PROFILE = load_rig_profile("rig-board-serial")
PERFECT = RigImperfections()
LAWS = {
    "magic-formula": (THESIS_LAW, THESIS_VALUES),
    "coulomb-stribeck": (CoulombStribeck(), (12.0, 0.38, 0.75, 0.15)),
    "brush": (Brush(), (12.0, 0.38)),
}
"""Slip laws of a simulated rig with their values."""


def world(law="magic-formula", *, plan=None, imperfections=PERFECT, dynamics=None, seed=0):
    return SimulatedRig(
        *LAWS[law],
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
