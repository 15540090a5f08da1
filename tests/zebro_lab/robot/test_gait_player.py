# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.gait.reference import SampledReference
from rig.zebro.profile import load_leg_profile
from zebro_lab.robot.gait_player import HORIZON, LEAD_IN, GaitPlayer

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
