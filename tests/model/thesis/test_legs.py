# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.errors import DomainError
from model.gait.steering import tripod_angles, tripod_reference
from model.thesis.legs import SwitchedLegs, leg_motion

GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
LEGS = SwitchedLegs.of(GAIT)


def test_legs_turn_at_one_speed_on_the_ground_and_another_in_flight():
    motion = LEGS.motion(0.001, 4000)
    turned = motion.theta % (2 * np.pi)
    grounded = (turned >= LEGS.touchdown) & (turned < LEGS.liftoff)
    np.testing.assert_array_equal(
        motion.speed, np.where(grounded, LEGS.ground_speed, LEGS.flight_speed)
    )
    np.testing.assert_allclose(np.diff(motion.theta, axis=0), 0.001 * motion.speed[:-1], atol=1e-12)


def test_switching_by_angle_tends_to_the_clock_as_steps_shorten():
    def off(dt):
        steps = round(4.0 / dt)
        by_angle, by_clock = (leg_motion(x, dt=dt, steps=steps) for x in (LEGS, GAIT))
        return np.abs(by_angle.theta - by_clock.theta).max()

    assert off(0.004) < 0.004 * 8 * GAIT.flight_speed.max()  # a step for each of eight switches
    assert off(0.0005) < off(0.004) / 4


def test_the_start_is_the_gaits():
    np.testing.assert_array_equal(LEGS.start, GAIT.angles(0.0)[0])


def test_pauses_and_offsets_are_refused():
    for other in (replace(GAIT, pause=np.full(6, 0.1)), replace(GAIT, offset=np.full(6, 0.1))):
        with pytest.raises(DomainError, match="by the clock"):
            SwitchedLegs.of(other)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"liftoff": LEGS.touchdown - 0.1}, "leg 1 touches down at 50 and lifts off at 44.2704"),
        ({"ground_speed": -LEGS.ground_speed}, "expected more than zero"),
        ({"start": np.full(6, np.nan)}, "expected six finite numbers"),
        ({"start": np.zeros(5)}, "expected six finite numbers"),
    ],
)
def test_legs_that_cannot_walk_are_refused(change, message):
    with pytest.raises(DomainError, match=message):
        replace(LEGS, **change)
