# SPDX-License-Identifier: MIT
"""Commands to the robot's legs, as bytes and as motion of the twin."""

import math

import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.device import iterate
from rig.errors import LimitExceeded, ProtocolError, RigTimeout
from rig.zebro.commands import HORIZON, LEAD_IN, GaitPlayer, follow, leave_still, milliseconds
from rig.zebro.profile import decode_angles, load_leg_profile
from support.leg_twins import standing as robot


@pytest.mark.parametrize("name", ["zebro-100-serial", "zebrobus-uart"])
def test_legs_go_to_their_set_points(name):
    stream, clock = robot(name)
    with stream:
        targets = (10, 20, 30, 40, 50, 60)
        assert stream.set_points(targets, 0.5)
        last = list(iterate(stream, duration=1.0, clock=clock))[-1]
    assert last.counts == targets


@pytest.mark.parametrize("name", ["zebro-100-serial", "zebrobus-uart"])
def test_stop_holds_every_leg(name):
    walking = SampledReference(np.array([0.0, 60.0]), np.array([[0.0] * 6, [240.0] * 6]))
    stream, clock = robot(name, gait=walking)
    with stream:
        moving = list(iterate(stream, duration=1.0, clock=clock))
        stream.stop()
        list(iterate(stream, duration=0.2, clock=clock))
        held = list(iterate(stream, duration=1.0, clock=clock))
    assert len({s.counts for s in moving}) > 10
    assert len({s.counts for s in held}) == 1


@pytest.mark.parametrize("name", ["zebro-100-serial", "zebrobus-uart"])
def test_leaving_the_driver_stops_legs_that_it_moved_and_no_others(name):
    walking = SampledReference(np.array([0.0, 60.0]), np.array([[0.0] * 6, [240.0] * 6]))
    for moved in (False, True):
        stream, clock = robot(name, gait=walking)
        with stream:
            if moved:
                stream.set_points((10, 20, 30, 40, 50, 60), 30.0)
            list(iterate(stream, duration=0.5, clock=clock))
        with stream:  # the twin goes on meanwhile
            later = list(iterate(stream, duration=2.0, clock=clock))[20:]
        assert (len({s.counts for s in later}) == 1) == moved


def test_leaving_a_driver_whose_link_takes_nothing_is_no_error():
    class Deaf:
        def stop(self):
            raise RigTimeout("the port takes no bytes", waited=1.0)

    leave_still(Deaf())


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

    def stop(self):
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


def test_the_legs_are_turned_gently_to_where_the_gait_begins():
    when, theta, duration = played(np.arange(50.0, 51.5, 0.01))
    assert (when[0], duration[0]) == (50.0, LEAD_IN)
    away = np.remainder(theta[0] - GAIT.angles(0.0)[0] + np.pi, 2 * np.pi) - np.pi
    assert np.abs(away).max() <= 0.51 * TURN
    assert when[1] >= 50.0 + LEAD_IN


def test_a_gait_called_in_time_is_in_time():
    when, theta, _ = played(np.arange(50.0, 60.0, 0.013))
    target = GAIT.angles(when[1:] - 50.0 - LEAD_IN + HORIZON)
    away = np.remainder(theta[1:] - target + np.pi, 2 * np.pi) - np.pi
    assert np.abs(away).max() <= 0.51 * TURN


@pytest.mark.parametrize("held_up", [0.2, 1.5])
def test_after_a_hold_up_the_legs_go_on_from_where_they_wait(held_up):
    calls = np.concatenate([np.arange(0.0, 3.0, 0.01), np.arange(3.0 + held_up, 8.0, 0.01)])
    when, theta, duration = played(calls)
    steps = np.diff(theta[1:], axis=0)
    assert steps.min() > -TURN
    assert steps.max() < SPEED * HORIZON + 1.01 * TURN
    assert set(duration[1:]) == {HORIZON}
    last = GAIT.angles(when[-1] - LEAD_IN + HORIZON - held_up)
    away = np.remainder(theta[-1] - last + np.pi, 2 * np.pi) - np.pi
    assert np.abs(away).max() < SPEED * HORIZON
