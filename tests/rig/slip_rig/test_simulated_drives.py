# SPDX-License-Identifier: MIT
"""The simulated drives turn both discs and stop them when the host falls silent."""

from contextlib import contextmanager

import can
import numpy as np
import pytest

from rig.device import iterate
from rig.errors import DeviceFault
from rig.links.can import CanLink
from rig.links.serve import Ticker
from rig.slip_rig.decode import decode_speeds
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.imperfections import RigImperfections
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, simulated_rig
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.sweep import SweepPlan

PROFILE = load_rig_profile("rig-odrive-netft")
WATCHDOG = 0.3


@contextmanager
def twin(request, **options):
    """Serve both drives; yield them and the driver, not yet entered."""
    channel = request.node.nodeid
    world = simulated_rig(
        plan=SweepPlan(),
        imperfections=RigImperfections(),
        dynamics=RigDynamics(),
        rng=np.random.default_rng(0),
    )
    with can.Bus(interface="virtual", channel=channel) as bus:
        axes = SimulatedDrives(world, bus, profile=PROFILE.drives, watchdog=WATCHDOG)
        with Ticker(axes.poll) as ticker:
            link = CanLink(f"virtual:{channel}", source=axes.source)
            yield axes, DriveBus(link, profile=PROFILE.drives, limits=PROFILE.limits, **options)
        assert ticker.failure is None


def turn(drives, leg=10.0, ground=2.0):
    drives.leg.arm(1.0)
    drives.ground.arm(1.0)
    drives.leg.set_speed(leg)
    drives.ground.set_speed(ground)


def healthy(drives):
    try:
        drives.require_healthy()
    except DeviceFault:
        return False
    return True


def test_discs_reach_their_speeds_and_slip_is_that_of_the_speeds(request, take):
    with twin(request) as (_, drives), drives:
        turn(drives)
        samples = take(drives, 100)
        drives.require_healthy()
    speeds = decode_speeds(PROFILE.drives.leg, PROFILE.drives.ground, samples)
    assert speeds.leg[-1] == pytest.approx(10.0, rel=0.01)
    assert speeds.ground[-1] == pytest.approx(2.0, rel=0.01)
    slip = 1 - 2.0 * PROFILE.radius_ground / (10.0 * PROFILE.radius_leg)
    assert speeds.slip(PROFILE)[-1] == pytest.approx(slip, abs=0.02)


def test_a_host_that_reads_no_more_is_stopped_by_the_watchdog(request, wait_until):
    with twin(request) as (axes, drives), drives:
        turn(drives)
        list(iterate(drives, duration=2 * WATCHDOG))
        assert axes.turning()  # reading feeds
        wait_until(lambda: not axes.turning())
        wait_until(lambda: not healthy(drives), reading=drives)
        with pytest.raises(DeviceFault, match="watchdog timer expired"):
            drives.require_healthy()
