# SPDX-License-Identifier: MIT
"""Shares of flight, body contact, load and sliding are those that the forces show."""

import numpy as np
import pytest

from model.gait import parse_gait, scheduled_reference, tripod_angles, tripod_reference
from model.gait.scheduler import straight_system
from model.robot import GRAVITY, Robot
from model.walk.dynamics import walk
from model.walk.path import WalkPath
from model.walk.support import support_of
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY


def walked(reference, duration=6.0):
    return walk(ROBOT, reference, VelocityCoulomb(0.38).table(weight=WEIGHT), duration=duration)


def hopping():
    """Return a gait that lifts all legs at once: the body falls onto the ground."""
    system = straight_system(parse_gait("{1,2,3,4,5,6}"), ground_time=0.8, flight_time=0.3)
    return scheduled_reference(system, np.radians(35), liftoff=np.radians(130))


def test_shares_are_counts_of_the_forces_and_forces_carry_the_weight():
    reference = hopping()
    path = walked(reference, 11.0)
    found = support_of(path, reference.stance_intervals((0.0, 11.0)))
    forces = np.column_stack([path.normal_force, path.body_force])
    nothing = np.mean([not row.any() for row in forces])
    assert found.flight == pytest.approx(nothing)
    assert found.flight > 0.1
    assert found.body == pytest.approx(np.mean(path.body_force > 0))
    assert found.body > 0.1
    for leg in range(6):
        assert found.loaded[leg] == pytest.approx(np.mean(path.normal_force[:, leg] > 0))
    assert forces.sum(axis=1)[path.t > 0].mean() == pytest.approx(WEIGHT, rel=0.02)


def test_a_tripod_neither_flies_nor_touches_with_its_body():
    reference = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0)
    found = support_of(walked(reference), reference.stance_intervals((0.0, 6.0)))
    assert (found.flight, found.body) == (0.0, 0.0)
    assert found.unloaded.max() < 0.05
    assert found.loaded == pytest.approx(np.full(6, 0.5), abs=0.05)


def path_of(contact, slip, body=0.0):
    n = len(contact)
    zero = np.zeros((n, 6))
    pairs = np.zeros((n, 6, 2))
    pairs[..., 0] = slip
    return WalkPath(np.arange(n, dtype=float), zero[:, :3], zero[:, :3], zero, contact, pairs,
                    zero, np.where(contact, 1.0, 0.0), 0 * pairs, body)  # fmt: skip


def test_sliding_is_counted_in_contact_and_load_within_the_stance():
    contact = np.zeros((10, 6), dtype=bool)
    contact[:5, 0] = contact[5:, 1] = True
    slip = np.zeros((10, 6))
    slip[3:, 0] = 0.02  # two of its five samples in contact
    stances = (np.array([[-1.0, 6.5]]), *[np.empty((0, 2))] * 5)  # leg 1 stands for seven samples
    found = support_of(path_of(contact, slip), stances)
    assert found.sliding[:2].tolist() == [0.4, 0.0]
    assert found.unloaded[0] == pytest.approx(2 / 7)
    assert np.isnan(found.sliding[2:]).all()
    assert np.isnan(found.unloaded[1:]).all()
    assert found.flight == 0.0


def test_flight_needs_a_body_off_the_ground_and_may_not_be_known():
    nothing = np.zeros((4, 6), dtype=bool)
    on_body = np.array([0.0, 2.0, 0.0, 0.0])
    found = support_of(path_of(nothing, 0.0, on_body))
    assert (found.flight, found.body) == (0.75, 0.25)
    unknown = support_of(path_of(nothing, 0.0, np.nan))
    assert unknown.flight == 1.0
    assert np.isnan(unknown.body)
