# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError, WalkError
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot
from model.slip import MagicFormula
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.stride import walk_by_strides
from model.walk.traction import law_table

ROBOT = Robot()
SOURCE = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
SLIP = law_table(MagicFormula("peak"), SOURCE, weight=ROBOT.mass * 9.81)
OPTIONS = DynamicsOptions(dt=0.005)
TURN = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0)
ROCK = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)


def whole(gait, duration, **options):
    return walk(ROBOT, gait, SLIP, duration=duration, options=OPTIONS, **options)


@pytest.mark.parametrize(("gait", "duration"), [(TURN, 31.0), (ROCK, 40.0)])
def test_the_stride_map_walks_where_every_step_does(gait, duration):
    by_steps = whole(gait, duration)
    by_strides = walk_by_strides(ROBOT, gait, SLIP, duration=duration, options=OPTIONS)
    np.testing.assert_allclose(by_strides.t, by_steps.t, atol=1e-9)
    distance = np.linalg.norm(by_strides.position - by_steps.position[:, :2], axis=1)
    assert distance.max() < 0.002 * by_steps.length
    assert np.abs(by_strides.yaw - by_steps.yaw).max() < np.radians(0.5)


@pytest.mark.parametrize("duration", [0.7, 2.0, 5.0])
def test_a_walk_shorter_than_its_settling_is_the_walk_itself(duration):
    by_strides = walk_by_strides(ROBOT, TURN, SLIP, duration=duration, options=OPTIONS)
    assert by_strides.t[-1] == pytest.approx(duration)
    path = whole(TURN, duration)
    # a stride's first step knows no acceleration to guess from, and settles elsewhere within bounds
    np.testing.assert_allclose(by_strides.position, path.position[:, :2], atol=1e-6)


def test_steps_are_shortened_to_fit_the_period():
    odd = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 1.0037)
    path = walk_by_strides(ROBOT, odd, SLIP, duration=3.0, options=OPTIONS)
    steps = np.diff(path.t)
    np.testing.assert_allclose(steps, steps[0], rtol=1e-9)
    assert steps[0] <= 0.005
    assert (odd.period / steps[0]) == pytest.approx(round(odd.period / steps[0]), abs=1e-9)


def test_a_log_has_no_stride():
    log = SampledReference(np.array([0.0, 1.0]), np.ones((2, 6)))
    with pytest.raises(WalkError, match="do not repeat"):
        walk_by_strides(ROBOT, log, SLIP, duration=1.0)


@pytest.mark.parametrize("duration", [0.0, -1.0, np.nan, np.inf])
def test_a_walk_of_no_time_is_refused(duration):
    with pytest.raises(DomainError, match="expected a finite time that rounds to at least"):
        walk_by_strides(ROBOT, TURN, SLIP, duration=duration, options=OPTIONS)
