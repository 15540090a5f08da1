# SPDX-License-Identifier: MIT
"""The simulated drives turn both discs and stop them when the host falls silent."""

import pytest

from rig.device import iterate
from rig.errors import DeviceFault
from rig.slip_rig.decode import decode_speeds, measured_slip
from support.drive_twins import PROFILE, WATCHDOG, healthy, turn, twin


def test_discs_reach_their_speeds_and_slip_is_that_of_the_speeds(request, take):
    with twin(request) as (_, drives), drives:
        turn(drives)
        samples = take(drives, 100)
        drives.require_healthy()
    speeds = decode_speeds(PROFILE.drives.leg, PROFILE.drives.ground, samples)
    assert speeds.leg[-1] == pytest.approx(10.0, rel=0.01)
    assert speeds.ground[-1] == pytest.approx(2.0, rel=0.01)
    slip = 1 - 2.0 * PROFILE.radius_ground / (10.0 * PROFILE.radius_leg)
    assert measured_slip(speeds.leg, speeds.ground, PROFILE)[-1] == pytest.approx(slip, abs=0.02)


def test_drives_that_restart_come_up_idle_and_take_no_speeds(request, wait_until):
    with twin(request) as (axes, drives), drives:
        turn(drives)
        wait_until(axes.turning, reading=drives)
        axes.restart()
        wait_until(lambda: not healthy(drives), reading=drives)
        assert not axes.turning()
        with pytest.raises(DeviceFault, match="left closed-loop control"):
            drives.require_healthy()


def test_a_host_that_reads_no_more_is_stopped_by_the_watchdog(request, wait_until):
    with twin(request) as (axes, drives), drives:
        turn(drives)
        list(iterate(drives, duration=2 * WATCHDOG))
        assert axes.turning()  # reading feeds
        wait_until(lambda: not axes.turning())
        wait_until(lambda: not healthy(drives), reading=drives)
        with pytest.raises(DeviceFault, match="watchdog timer expired"):
            drives.require_healthy()
