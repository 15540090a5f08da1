# SPDX-License-Identifier: MIT
"""Drives and load cell with their twins on a clock turned by hand: no thread, port or waiting."""

import math
from collections import deque

import can
import numpy as np

from rig.backends import RigDevices
from rig.links.can import CanLink
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell

STEP = 0.01
"""Longest time between two polls of the drives [s]."""


class SteppedBus(can.BusABC):
    """One end of a bus; waiting at the host's end turns the clock and polls the drives."""

    def __init__(self, clock=None):
        super().__init__(channel=None)
        self.clock, self.inbox, self.peer, self.twin = clock, deque(), None, None
        self._is_shutdown = True  # there is nothing to close

    def send(self, message, timeout=None):
        self.peer.inbox.append(message)

    def recv(self, timeout=None):
        if self.twin is not None and not self.inbox:
            self.clock.sleep(timeout or 0.0)
            self.twin.poll(self.clock.now())
        return self.inbox.popleft() if self.inbox else None

    def shutdown(self):
        self.twin.poll(self.clock.now())  # which gets the last commands


class SteppedCell(SimulatedLoadCell):
    """A load cell that is its own link."""

    def __init__(self, rig, *, profile, clock):
        super().__init__(rig, profile=profile, rng=np.random.default_rng(3))
        self._clock, self._out = clock, []

    def open(self):
        pass

    def close(self):
        pass

    def write(self, data):
        self._handle(data, ("memory", 0))

    def read(self, timeout):
        self.poll(self._clock.now())
        out, self._out = self._out, []
        return out

    def _emit(self, datagram):
        if self._client is not None:
            self._out.append(datagram)


def stepped_drives(rig, profile, clock, *, watchdog):
    """Return the drives' twin and the devices of the rig, not yet entered."""
    host, far = SteppedBus(clock), SteppedBus()
    host.peer, far.peer = far, host
    host.twin = SimulatedDrives(rig, far, profile=profile.drives, watchdog=watchdog)
    sleep = clock.sleep

    def stepping(duration):
        """Let the drives live on while the program sleeps."""
        steps = max(math.ceil(duration / STEP), 1)
        for _ in range(steps):
            sleep(duration / steps)
            host.twin.poll(clock.now())

    clock.sleep = stepping
    link = CanLink(host, source=host.twin.source, clock=clock)
    drives = DriveBus(link, profile=profile.drives, limits=profile.limits, clock=clock)
    link = SteppedCell(rig, profile=profile.load_cell, clock=clock)
    cell = NetFtCell(link, profile=profile.load_cell, clock=clock)
    return host.twin, RigDevices(profile, drives=drives, load_cell=cell)
