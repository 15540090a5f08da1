# SPDX-License-Identifier: MIT
"""Every robot takes set-points and stops, whatever its layout; a gait is played in time."""

import math
from contextlib import contextmanager
from functools import partial

import can
import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.backends import leg_driver
from rig.clock import ManualClock
from rig.device import iterate
from rig.errors import LimitExceeded, ProtocolError, RigTimeout
from rig.links.can import CanLink
from rig.zebro.commands import HORIZON, LEAD_IN, GaitPlayer, follow, milliseconds
from rig.zebro.profile import decode_angles, load_leg_profile
from rig.zebro.simulated import CanRobot
from rig.zebro.simulated_legs import SimulatedLegs
from support.leg_twins import STANDING
from support.leg_twins import standing as robot

COMMANDED = ["zebro-100-serial", "zebrobus-uart", "zebro-100-can"]
WALKING = SampledReference(np.array([0.0, 60.0]), np.array([[0.0] * 6, [240.0] * 6]))
TARGETS = (10, 20, 30, 40, 50, 60)


class PolledBus(CanLink):
    """A link that polls the twin behind its bus before each read, as a byte link in memory does."""

    poll = staticmethod(lambda now: None)

    def read(self, timeout):
        self._clock.sleep(timeout)
        self.poll(self._clock.now())
        return super().read(0.0)


@contextmanager
def driver(name, gait=STANDING):
    """Yield a function that makes a driver of one robot, and the robot's clock."""
    if name != "zebro-100-can":
        stream, clock = robot(name, gait=gait)
        yield stream, clock
        return
    clock, profile = ManualClock(), load_leg_profile(name)
    with can.Bus(interface="virtual", channel="commanded") as bus:
        legs = SimulatedLegs(gait, profile=profile)
        link = PolledBus("virtual:commanded", clock=clock)
        link.poll = CanRobot(legs, bus, rng=np.random.default_rng(0)).poll
        yield leg_driver(profile, link, clock=clock), clock


@pytest.mark.parametrize("name", COMMANDED)
def test_legs_go_to_their_set_points_and_stop(name):
    with driver(name, WALKING) as (stream, clock), stream:
        read = partial(iterate, stream, clock=clock, wait=0.01)
        assert len({s.counts for s in read(duration=1.0)}) > 10
        assert stream.stop()
        list(read(duration=0.2))
        assert len({s.counts for s in read(duration=1.0)}) == 1
        assert stream.set_points(TARGETS, 0.5)
        assert list(read(duration=1.0))[-1].counts == TARGETS


@pytest.mark.parametrize("name", COMMANDED)
@pytest.mark.parametrize("moved", [False, True])
def test_leaving_the_driver_stops_legs_that_it_moved_and_no_others(name, moved):
    with driver(name, WALKING) as (stream, clock):
        read = partial(iterate, stream, clock=clock, wait=0.01)
        with stream:
            if moved:
                stream.set_points(TARGETS, 30.0)
            list(read(duration=0.5))
        with stream:  # the twin goes on meanwhile
            later = list(read(duration=2.0))[20:]
        assert (len({s.counts for s in later}) == 1) == moved


def test_leaving_a_driver_whose_link_takes_nothing_is_no_error(monkeypatch):
    stream, _ = robot()
    with stream:
        stream.set_points(TARGETS, 1.0)

        def deaf(data):
            raise RigTimeout("the port takes no bytes", waited=1.0)

        monkeypatch.setattr(stream._link, "write", deaf)


def test_following_a_gait_walks_it():
    t = np.linspace(0, 10, 101)
    gait = SampledReference(t, np.outer(t, np.full(6, 3.0)) + np.linspace(0.2, 1.2, 6))
    stream, clock = robot()
    with stream:
        samples, start = [], clock.now()
        while clock.now() - start < 5.0:
            follow(stream, gait, start=start, now=clock.now(), horizon=0.05)
            samples += stream.read(0.02)
    angles = decode_angles(stream.profile, samples)
    error = angles.theta - gait.angles(angles.device_time)
    assert np.max(np.abs(error[20:])) < 3 * stream.profile.quantisation


def test_a_dump_refuses_set_points_and_says_that_it_cannot_stop():
    stream, _ = robot("vregs-dump")
    with stream:
        assert stream.stop() is False
        with pytest.raises(ProtocolError, match="takes no set-points"):
            stream.set_points((1,), 0.1)


@pytest.mark.parametrize("duration", [-0.1, 66.0, math.nan])
def test_a_motion_longer_than_the_protocol_can_say_is_refused(duration):
    with pytest.raises(LimitExceeded, match="s; its limit"):
        milliseconds(duration)


PROFILE = load_leg_profile("zebro-100-serial")
SPEED = 3.0
TIMES = np.linspace(0.0, 30.0, 301)
GAIT = SampledReference(TIMES, np.outer(TIMES, np.full(6, SPEED)) + np.arange(6))
TURN = 2 * np.pi / PROFILE.counts_per_revolution


class Legs:
    """Takes set-points, and keeps when they came."""

    profile = PROFILE

    def __init__(self):
        self.now = 0.0
        self.commands = []

    def set_points(self, counts, duration):
        self.commands.append((self.now, counts, duration))
        return True


def played(calls):
    """Call a player at host times; return what it commanded: when, unwrapped targets, how long."""
    legs = Legs()
    player = GaitPlayer(legs, GAIT, PROFILE)
    for legs.now in calls:
        player(legs.now)
    when, counts, duration = zip(*legs.commands, strict=True)
    theta = np.unwrap(np.array(counts) * PROFILE.sign * TURN, axis=0)
    return np.array(when), theta, np.array(duration)


def away(theta, target):
    """Return the largest difference of two leg angles, without whole turns [rad]."""
    return np.abs(np.remainder(theta - target + np.pi, 2 * np.pi) - np.pi).max()


def test_the_legs_are_turned_gently_to_where_the_gait_begins_and_are_in_time():
    when, theta, duration = played(np.arange(50.0, 60.0, 0.013))
    assert (when[0], duration[0]) == (50.0, LEAD_IN)
    assert away(theta[0], GAIT.angles(0.0)[0]) <= 0.51 * TURN
    assert when[1] >= 50.0 + LEAD_IN
    target = GAIT.angles(when[1:] - 50.0 - LEAD_IN + HORIZON)
    assert away(theta[1:], target) <= 0.51 * TURN


@pytest.mark.parametrize("held_up", [0.2, 1.5])
def test_after_a_hold_up_the_legs_go_on_from_where_they_wait(held_up):
    calls = np.concatenate([np.arange(0.0, 3.0, 0.01), np.arange(3.0 + held_up, 8.0, 0.01)])
    when, theta, duration = played(calls)
    steps = np.diff(theta[1:], axis=0)
    assert steps.min() > -TURN
    assert steps.max() < SPEED * HORIZON + 1.01 * TURN
    assert set(duration[1:]) == {HORIZON}
    last = GAIT.angles(when[-1] - LEAD_IN + HORIZON - held_up)
    assert away(theta[-1], last) < SPEED * HORIZON
