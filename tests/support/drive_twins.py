# SPDX-License-Identifier: MIT
"""The slip rig's drives and their twin on a virtual CAN bus."""

from contextlib import contextmanager

import can

from rig.errors import DeviceFault
from rig.links.can import CanLink
from rig.links.serve import Ticker
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated_drives import SimulatedDrives
from support.board_twins import world

PROFILE = load_rig_profile("rig-odrive-netft")


WATCHDOG = 0.3


@contextmanager
def twin(request, **options):
    """Serve both drives; yield them and the driver, not yet entered."""
    channel = request.node.nodeid
    with can.Bus(interface="virtual", channel=channel) as bus:
        axes = SimulatedDrives(world(), bus, profile=PROFILE.drives, watchdog=WATCHDOG)
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
