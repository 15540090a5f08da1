# SPDX-License-Identifier: MIT
"""The load cell's driver over its twin by UDP, and a link that gives prepared datagrams."""

from contextlib import contextmanager

import numpy as np

from rig.links.faults import PERFECT_LINE
from rig.links.serve import Ticker
from rig.links.udp import UdpLink
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.slip_rig.sweep import SweepPlan
from support.board_twins import world

PROFILE = load_rig_profile("rig-odrive-netft").load_cell


@contextmanager
def twin(faults=PERFECT_LINE, *, buffered=False):
    """Serve a cell under 8 N; yield it and the driver, not yet entered."""
    rng = np.random.default_rng(0)
    rig = world(plan=SweepPlan(loads=(8.0,)))
    with SimulatedLoadCell(rig, profile=PROFILE, faults=faults, rng=rng) as cell:
        with Ticker(cell.poll) as ticker:
            link = UdpLink(cell.host, cell.port, source=cell.source)
            yield cell, NetFtCell(link, profile=PROFILE, buffered=buffered)
        assert ticker.failure is None


class OneRead(UdpLink):
    """Gives the same datagrams whenever it is read."""

    def __init__(self, *datagrams):
        super().__init__("127.0.0.1", 1)
        self._datagrams = list(datagrams)

    def read(self, timeout):
        return self._datagrams
