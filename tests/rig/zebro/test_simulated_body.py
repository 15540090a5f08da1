# SPDX-License-Identifier: MIT
"""The body moves as its legs do: as the walking model without slip, and not where they stand."""

import numpy as np
import pytest

from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.walk.no_slip import walk_no_slip
from rig.zebro.profile import load_leg_profile
from rig.zebro.simulated_body import SimulatedBody
from rig.zebro.simulated_legs import SimulatedLegs

PROFILE = load_leg_profile("zebro-100-serial")
STANDING = SampledReference(np.array([0.0, 1.0]), np.full((2, 6), np.pi / 2))


def walked(gait, times, *, began=100.0):
    legs = SimulatedLegs(gait, profile=PROFILE)
    body = SimulatedBody(legs)
    return legs, np.array([body(began + t) for t in times])


def turning(steering, direction):
    angles = tripod_angles(np.radians(50), steering)
    return tripod_reference(angles, 2.0, direction=direction)


@pytest.mark.parametrize(("steering", "direction"), [(1.0, "left"), (1.2, "left"), (1.2, "right")])
def test_the_body_moves_as_a_walk_without_slip(steering, direction):
    gait = turning(steering, direction)
    path = walk_no_slip(Robot(), gait, duration=6.0, dt=0.002)
    _, attitude = walked(gait, path.t[::5])
    np.testing.assert_allclose(attitude, path.orientation[::5], atol=2e-4)
    assert abs(attitude[-1, 2]) > np.radians(15) or steering == 1.0


def test_a_body_on_legs_that_stand_is_still():
    _, attitude = walked(STANDING, np.arange(0, 2, 0.01))
    assert np.ptp(attitude, axis=0).max() == 0.0


def test_a_body_stops_where_its_legs_are_stopped():
    gait = turning(1.2, "left")
    legs = SimulatedLegs(gait, profile=PROFILE)
    body = SimulatedBody(legs)
    walking = [body(t) for t in np.arange(0, 2, 0.01)]
    legs.stop(2.0)
    held = [body(t) for t in np.arange(2.01, 3, 0.01)]
    assert np.ptp([yaw for *_, yaw in walking]) > 0.02
    assert np.ptp(held, axis=0).max() < 1e-12


def test_a_body_that_no_legs_hold_keeps_its_attitude():
    up = SampledReference(np.array([0.0, 1.0]), np.array([[np.pi / 2] * 6, [np.pi / 2] * 6]))
    up.theta[:, [0, 2]] = -np.pi / 2  # of the left legs one alone reaches down
    up.theta[:, 4] = -np.pi / 2
    _, attitude = walked(up, np.arange(0, 1, 0.01))
    assert np.isfinite(attitude).all()
    assert len(np.unique(attitude, axis=0)) == 1
