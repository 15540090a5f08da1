# SPDX-License-Identifier: MIT
"""The drives of the slip rig against their twin on a virtual CAN bus."""

import math
import time
from contextlib import contextmanager

import can
import numpy as np
import pytest

from rig.clock import ManualClock
from rig.errors import DeviceFault, LimitExceeded, RigTimeout
from rig.links.can import CanLink
from rig.links.slcan import SlcanAdapter
from rig.slip_rig.can_simple import (
    ESTIMATES,
    Command,
    can_id,
)
from rig.slip_rig.drives import DriveBus, disc_speed
from rig.slip_rig.imperfections import RigImperfections
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.sweep import SweepPlan
from support.drive_twins import PROFILE, WATCHDOG, healthy, turn, twin


def test_leaving_stops_the_discs(request, wait_until):
    with twin(request) as (axes, drives):
        with drives:
            turn(drives)
            wait_until(axes.turning, reading=drives)
        wait_until(lambda: not axes.turning())


def test_leaving_by_an_error_stops_the_discs(request, wait_until):
    with twin(request) as (axes, drives):
        with pytest.raises(LimitExceeded), drives:
            turn(drives, leg=1e6)
        wait_until(lambda: not axes.turning())


def test_a_fault_of_a_drive_is_spelled_out_and_arming_again_clears_it(request, wait_until):
    with twin(request) as (axes, drives), drives:
        turn(drives)
        axes.trip("ground", 0x40)
        wait_until(lambda: not healthy(drives), reading=drives)
        with pytest.raises(DeviceFault, match="ground disc reports motor failed") as fault:
            drives.require_healthy()
        assert fault.value.status == 0x40
        drives.ground.arm(1.0)
        drives.require_healthy()


@pytest.mark.parametrize("omega", [40.1, -40.1, math.nan, math.inf])
def test_a_speed_beyond_the_limit_is_refused_before_motion(request, omega):
    with twin(request) as (axes, drives), drives:
        drives.leg.arm(1.0)
        with pytest.raises(LimitExceeded, match="rad/s; its limit is 40 rad/s"):
            drives.leg.set_speed(omega)
        drives.read(0.05)
        assert not axes.turning()


def test_drives_that_are_not_there_are_missed_in_time():
    drives = DriveBus(CanLink("virtual:nobody"), profile=PROFILE.drives, limits=PROFILE.limits)
    began = time.monotonic()
    with pytest.raises(RigTimeout, match="no heartbeat"), drives:
        pass
    assert time.monotonic() - began < 1.5


def test_an_estimate_that_is_no_number_is_refused(request, wait_until):
    other = can.Bus(interface="virtual", channel=request.node.nodeid)
    with twin(request) as (_, drives), drives, other:
        for data in (ESTIMATES.pack(math.nan, 1.0), b"\0\0"):
            arbitration_id = can_id(0, Command.ENCODER_ESTIMATES)
            other.send(can.Message(arbitration_id=arbitration_id, data=data, is_extended_id=False))
        samples = wait_until(lambda: drives.counters.refused == 2, reading=drives)
    assert all(math.isfinite(sample.counts[0]) for sample in samples)


class AdapterPort:
    """Stands for pyserial's port in python-can's slcan: adapter and drives by a manual clock."""

    def __init__(self, adapter, drives, clock):
        self.adapter, self.drives, self.clock = adapter, drives, clock
        self.inbox, self.outbox = bytearray(), b""
        self.write_timeout = None

    def _poll(self):
        self.drives.poll(self.clock.now())
        received, self.outbox = self.outbox, b""
        self.inbox += self.adapter.poll(self.clock.now(), received)

    @property
    def in_waiting(self):
        self._poll()
        return len(self.inbox)

    def read(self, size):
        if not self.inbox:
            self.clock.sleep(0.001)  # the port's own time limit
            self._poll()
        data = bytes(self.inbox[:size])
        del self.inbox[:size]
        return data

    def write(self, data):
        self.outbox += data

    def flush(self):
        pass

    def close(self):
        pass


@contextmanager
def behind_an_adapter(request):
    """Yield a rig, a manual clock, and the driver of its drives behind an SLCAN adapter."""
    world = SimulatedRig(
        plan=SweepPlan(), imperfections=RigImperfections(), dynamics=RigDynamics(),
        rng=np.random.default_rng(0),
    )  # fmt: skip
    clock = ManualClock()
    channel = request.node.nodeid
    with (
        can.Bus(interface="virtual", channel=channel) as near,
        can.Bus(interface="virtual", channel=channel) as far,
        can.Bus(interface="slcan", channel="loop://", sleep_after_open=0.0) as slcan,
    ):
        slcan.serialPortOrig.close()
        axes = SimulatedDrives(world, near, profile=PROFILE.drives, watchdog=WATCHDOG)
        slcan.serialPortOrig = AdapterPort(SlcanAdapter(far, source="sim:rig"), axes, clock)
        slcan.open()
        link = CanLink(slcan, clock=clock)
        yield (
            world,
            clock,
            DriveBus(link, profile=PROFILE.drives, limits=PROFILE.limits, clock=clock),
        )


def test_a_speed_read_over_slcan_in_a_ramp_is_not_behind(request):
    with behind_an_adapter(request) as (world, clock, drives), drives:
        turn(drives, leg=0.0, ground=0.0)
        began, seen = clock.now(), []
        while (elapsed := clock.now() - began) < 4.0:
            drives.leg.set_speed(3.0 * elapsed)
            drives.ground.set_speed(elapsed)
            clock.sleep(0.004)
            samples = drives.read(0.0)
            seen += [s for s in samples if s.channel == PROFILE.drives.leg.node]
        drives.require_healthy()
    assert len(seen) > 300
    assert seen[-1].host_time > clock.now() - 0.02
    speed = disc_speed(PROFILE.drives.leg, seen[-1].counts[1])
    assert speed == pytest.approx(world.speeds()["leg"][1], abs=0.2)
