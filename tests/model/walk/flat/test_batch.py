# SPDX-License-Identifier: MIT
"""Walks on flat ground against the general loop, alone and side by side."""

from dataclasses import replace

import numpy as np
import pytest

from model.gait.notation import TETRAPOD, TRIPOD
from model.gait.program import cycle_gait
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.lanes import LANES
from model.robot import GRAVITY, N_LEGS, Robot
from model.slip import MagicFormula
from model.walk.arrays import Contacts, State, body_arrays
from model.walk.dynamics import DynamicsOptions, start_state
from model.walk.flat.batch import FlatWalk, is_flat_walk, run_side_by_side
from model.walk.ground import FLAT, with_slope
from model.walk.loop import run_steps
from model.walk.program import Segment, Until, lay_out
from model.walk.traction import VelocityCoulomb, law_table

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
VALUES = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
CURVE = law_table(MagicFormula("peak"), VALUES, weight=WEIGHT)
EVEN = law_table(MagicFormula("peak"), VALUES * [1.0, 1.0, 1.1, 0.9], weight=WEIGHT)
COULOMB = VelocityCoulomb(0.3).table(weight=WEIGHT)
TURN = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 1.0)
ROCK = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=1.5)
DT = 0.005


def copied(state):
    return State(*(each.copy() for each in state))


def general(walk, dt, n):
    """Walk by the general loop from a copy of the state."""
    pose, legs = np.empty((n, 7)), np.empty((n, N_LEGS + 1, 6))
    run_steps(
        body_arrays(walk.robot), walk.table, FLAT, walk.contacts, copied(walk.state), walk.theta,
        dt, pose, legs,
    )  # fmt: skip
    return pose, legs


def four_walks(dt=DT, seconds=1.5):
    """Return walks that differ in gait, arc, law, offsets and contacts, one falling on its body."""
    rng = np.random.default_rng(4)
    t = dt * np.arange(round(seconds / dt) + 1)
    fallen = np.full((len(t), N_LEGS), -np.pi / 2)
    walks = []
    for arc, table, theta, stiffness in (
        (180.0, CURVE, TURN.angles(t), 1.0), (200.0, EVEN, ROCK.angles(t), 2.0),
        (150.0, COULOMB, TURN.angles(t), 0.5), (180.0, CURVE, fallen, 1.0),
    ):  # fmt: skip
        theta = theta + np.radians(1.0) * rng.standard_normal(N_LEGS)
        robot = replace(ROBOT, leg_arc=np.radians(arc))
        state = start_state(robot, theta[0], DynamicsOptions())
        state.v[:] = 0.05, 0.0, -0.1
        walks.append(FlatWalk(robot, table, Contacts(2e5 * stiffness, 200.0), state, theta))
    return walks


@pytest.mark.parametrize("dt", [DT, 0.0004])
def test_walks_side_by_side_are_those_of_the_general_loop_to_rounding(dt):
    walks = four_walks(dt, 1.5 if dt == DT else 0.2)
    n = len(walks[0].theta) - 1
    expected = [general(walk, dt, n) for walk in walks]
    pose, legs, done = run_side_by_side(walks, dt, keep_legs=True)
    assert done == [n] * 4
    for i, (path, rows) in enumerate(expected):
        np.testing.assert_allclose(pose[i, 1:], path, atol=1e-10, err_msg=str(i))
        np.testing.assert_allclose(legs[i], rows, rtol=1e-5, atol=1e-6, err_msg=str(i))


@pytest.mark.parametrize("i", [0, 2, 3])
def test_one_walk_is_that_of_the_general_loop_to_rounding(i):
    walk = four_walks()[i]
    expected = general(walk, DT, len(walk.theta) - 1)
    pose, legs, _ = run_side_by_side([walk], DT, keep_legs=True)
    np.testing.assert_allclose(pose[0, 1:], expected[0], atol=1e-10)
    np.testing.assert_allclose(legs[0], expected[1], rtol=1e-5, atol=1e-6)


def directed_walks(dt=DT, seconds=1.5):
    """Return the four walks, of which three differ along and across the rolling direction."""
    factors = ((1.3, 0.7), (0.6, 1.7), (1.5, 2.0), (1.0, 1.0))
    return [
        replace(walk, table=walk.table._replace(lateral_grip=a, lateral_stiffness=b))
        for walk, (a, b) in zip(four_walks(dt, seconds), factors, strict=True)
    ]


def test_walks_by_directed_laws_are_those_of_the_general_loop_to_rounding():
    walks = directed_walks()
    n = len(walks[0].theta) - 1
    expected = [general(walk, DT, n) for walk in walks]
    alone, _, _ = run_side_by_side([directed_walks()[1]], DT)
    pose, legs, done = run_side_by_side(walks, DT, keep_legs=True)
    assert done == [n] * 4
    np.testing.assert_allclose(alone[0, 1:], expected[1][0], atol=1e-9)
    for i, (path, rows) in enumerate(expected):
        np.testing.assert_allclose(pose[i, 1:], path, atol=1e-9, err_msg=str(i))
        np.testing.assert_allclose(legs[i], rows, rtol=1e-4, atol=1e-5, err_msg=str(i))


def test_a_walk_does_not_depend_on_its_neighbours():
    walks = four_walks()
    full, _, _ = run_side_by_side(walks, DT)
    part, legs, done = run_side_by_side(four_walks()[1:3], DT)
    np.testing.assert_array_equal(part, full[1:3])
    assert legs.shape == (2, 0, N_LEGS + 1, 6)
    assert len(done) == 2


def test_the_last_state_is_left_where_the_walk_ended():
    walk = four_walks()[0]
    pose, _, _ = run_side_by_side([walk] * LANES, DT)
    np.testing.assert_array_equal(walk.state.p, pose[0, -1, :3])
    np.testing.assert_array_equal(walk.state.q, pose[0, -1, 3:])


def test_a_walk_that_diverges_ends_and_the_others_go_on():
    walks = four_walks()
    walks[1].theta[100, 2] = np.nan
    pose, _, done = run_side_by_side(walks, DT)
    n = len(walks[0].theta) - 1
    assert done == [n, 99, n, n]
    assert np.isfinite(pose[[0, 2, 3]]).all()


def test_bristles_and_slopes_are_left_to_the_general_loop():
    assert is_flat_walk(CURVE, FLAT)
    assert not is_flat_walk(CURVE._replace(bristle=True), FLAT)
    assert not is_flat_walk(CURVE, with_slope(FLAT, 0.1, 0.0))


def random_walks(rng, seconds=1.5):
    """Return walks of a program each, spot turns to straight, on legs mounted 5 degrees off."""
    t = DT * np.arange(round(seconds / DT) + 1)
    walks = []
    for steering in (-1.0, *rng.uniform(-1.0, 1.0, LANES - 1)):
        groups = TRIPOD if rng.uniform() < 0.5 else TETRAPOD
        gait = cycle_gait(groups, ground_time=0.5, flight_time=0.25, steering=steering)
        legs, _ = lay_out([Segment(gait, Until(strides=2))], ROBOT, None, options=DynamicsOptions())
        theta = legs.reference().angles(t) + np.radians(5.0) * rng.standard_normal(N_LEGS)
        table = VelocityCoulomb(rng.uniform(0.1, 1.0)).table(weight=WEIGHT)
        if rng.uniform() < 0.5:
            table = CURVE._replace(phi=CURVE.phi * rng.uniform(0.3, 1.5))
        contacts = Contacts(*np.exp(rng.standard_normal(2)) * [2e5, 200.0])
        state = start_state(ROBOT, theta[0], DynamicsOptions())
        walks.append(FlatWalk(ROBOT, table, contacts, state, theta))
    return walks


@pytest.mark.parametrize("seed", range(3))
def test_random_walks_and_turns_on_dragging_feet_are_those_of_the_general_loop(seed):
    walks = random_walks(np.random.default_rng(seed))
    expected = [general(walk, DT, len(walk.theta) - 1) for walk in walks]
    pose, legs, _ = run_side_by_side(walks, DT, keep_legs=True)
    dragged = 0.0
    for i, (path, rows) in enumerate(expected):
        np.testing.assert_allclose(pose[i, 1:], path, atol=1e-8, err_msg=str(i))
        np.testing.assert_allclose(legs[i], rows, rtol=1e-4, atol=1e-4, err_msg=str(i))
        dragged = max(dragged, np.nanmax(np.hypot(*rows[:, :N_LEGS, 3:5].T)))
    assert dragged > 0.05  # m/s
