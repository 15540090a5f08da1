# SPDX-License-Identifier: MIT
"""The drives of the slip rig against their twin on a virtual CAN bus."""

import math
import time

import can
import pytest

from rig.errors import DeviceFault, LimitExceeded, RigTimeout
from rig.links.can import CanLink
from rig.slip_rig.can_simple import (
    ESTIMATES,
    Command,
    can_id,
)
from rig.slip_rig.drives import DriveBus
from support.drive_twins import PROFILE, healthy, turn, twin


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
