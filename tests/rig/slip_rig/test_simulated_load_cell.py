# SPDX-License-Identifier: MIT
"""The simulated cell forgets clients, and serves its configuration."""

import time
from contextlib import contextmanager

import numpy as np

from rig.links.faults import PERFECT_LINE
from rig.links.serve import Ticker
from rig.links.udp import UdpLink
from rig.slip_rig.decode import decode_forces
from rig.slip_rig.imperfections import RigImperfections
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.slip_rig.sweep import SweepPlan

PROFILE = load_rig_profile("rig-odrive-netft").load_cell


@contextmanager
def twin(faults=PERFECT_LINE, *, buffered=False):
    world = SimulatedRig(
        plan=SweepPlan(loads=(8.0,)),
        imperfections=RigImperfections(),
        dynamics=RigDynamics(),
        rng=np.random.default_rng(0),
    )
    rng = np.random.default_rng(0)
    with SimulatedLoadCell(world, profile=PROFILE, faults=faults, rng=rng) as cell:
        with Ticker(cell.poll) as ticker:
            link = UdpLink(cell.host, cell.port, source=cell.source)
            yield cell, NetFtCell(link, profile=PROFILE, buffered=buffered)
        assert ticker.failure is None


def test_bias_makes_the_present_reading_zero(take):
    with twin() as (_, stream), stream:
        take(stream, 1)
        stream.bias()
        take(stream, 3000)  # what was under way when the cell took its zero
        forces = decode_forces(PROFILE, take(stream, 1))
    assert np.abs(forces.normal).max() < 1e-5


def test_a_cell_that_forgot_its_client_is_asked_again_and_the_gap_is_counted(take):
    with twin() as (cell, stream), stream:
        take(stream, 1000)
        cell._client = None  # as after a loss of power
        while stream.read(0.2):
            pass
        take(stream, 1)
    assert stream.counters.reconnected == 1
    assert stream.counters.restarted == 1


def test_leaving_stops_the_cell(take, wait_until):
    with twin() as (cell, stream):
        with stream:
            take(stream, 1)
        wait_until(lambda: cell._client is None)
        sent = cell.sent
        time.sleep(0.05)
        assert cell.sent == sent
