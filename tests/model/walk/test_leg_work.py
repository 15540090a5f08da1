# SPDX-License-Identifier: MIT
"""Work of the legs is the change of the body's energy and what slip and contacts take."""

from dataclasses import replace

import numpy as np
import pytest

from model.gait.notation import TRIPOD
from model.gait.program import ProgramLegs, cycle_gait
from model.gait.reference import SampledReference
from model.robot import GRAVITY, N_LEGS, Robot
from model.walk.dynamics import DynamicsOptions, Start, integrate, start_state, step_times, walk
from model.walk.ground import FLAT
from model.walk.leg_work import leg_work
from model.walk.quaternion import roll_pitch_yaw
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
COULOMB = VelocityCoulomb(0.38)
UPHILL = FLAT._replace(slope_x=np.tan(np.radians(5.0)))
CURVE = cycle_gait(TRIPOD, ground_time=1.0, flight_time=1.0, steering=0.3)
SPOT = cycle_gait(TRIPOD, ground_time=1.0, flight_time=1.0, steering=-1.0)
LEGS = ProgramLegs.beginning_with(CURVE).with_cycle(CURVE).with_cycle(SPOT)


def energy(state):
    """Return kinetic and potential energy of the body [J]."""
    roll, pitch, yaw = roll_pitch_yaw(state.q[None])[0]
    cos, sin = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    R_x = np.array([[1, 0, 0], [0, cos[0], -sin[0]], [0, sin[0], cos[0]]])
    R_y = np.array([[cos[1], 0, sin[1]], [0, 1, 0], [-sin[1], 0, cos[1]]])
    R_z = np.array([[cos[2], -sin[2], 0], [sin[2], cos[2], 0], [0, 0, 1]])
    rate = (R_z @ R_y @ R_x).T @ state.w  # in the body's axes
    moving = ROBOT.mass * state.v @ state.v + rate @ (ROBOT.principal_inertia * rate)
    return 0.5 * moving + WEIGHT * state.p[2]


def unbalanced(dt, *, ground=FLAT, lateral=(1.0, 1.0)):
    """Return energies of a walk, the gain of the body, and what is missing in the balance [J]."""
    t, options = step_times(LEGS.end, dt), DynamicsOptions(dt=dt)
    table = COULOMB.table(weight=WEIGHT)
    table = table._replace(lateral_grip=lateral[0], lateral_stiffness=lateral[1])
    theta = LEGS.reference().angles(t)
    state = start_state(ROBOT, theta[0], options, ground=ground)
    before = energy(state)
    _, rows = integrate(ROBOT, table, state, theta, options, ground=ground, keep_legs=True)
    done, taken_back, slip, contacts = rows[:, N_LEGS, 1:5].sum(axis=0)
    gain = energy(state) - before
    return done, gain, done - taken_back - gain - slip - contacts


@pytest.mark.parametrize("ground", [FLAT, UPHILL], ids=["level", "uphill"])
def test_the_energies_balance_and_the_better_the_finer_the_step(ground):
    done, _, missing = unbalanced(0.002, ground=ground)
    assert abs(missing) < 0.005 * done
    coarse, fine = (unbalanced(dt, ground=ground)[2] for dt in (0.0005, 0.000125))
    assert abs(fine) < 0.4 * abs(coarse)


@pytest.mark.parametrize("ground", [FLAT, UPHILL], ids=["level", "uphill"])
def test_the_energies_balance_where_grip_is_less_across_the_legs(ground):
    done, _, missing = unbalanced(0.002, ground=ground, lateral=(0.6, 1.5))
    assert abs(missing) < 0.005 * done


def test_uphill_the_legs_lift_the_body():
    level, uphill = unbalanced(0.002), unbalanced(0.002, ground=UPHILL)
    assert uphill[1] > level[1] + 0.1
    assert uphill[0] > level[0] + 0.1


def test_the_work_converges_in_the_step():
    fine = unbalanced(0.0000625)[0]
    assert unbalanced(0.002)[0] == pytest.approx(fine, rel=0.025)
    assert unbalanced(0.000125)[0] == pytest.approx(fine, rel=0.004)


def test_power_is_torque_at_the_hip_times_leg_speed():
    dt = 0.0005  # no step is divided
    path = walk(
        ROBOT, LEGS.reference(), COULOMB.table(weight=WEIGHT), duration=LEGS.end,
        options=DynamicsOptions(dt=dt),
    )  # fmt: skip
    speed = np.diff(path.theta, axis=0, prepend=path.theta[:1]) / dt
    arm_x, arm_z = arms(path)
    torque = arm_z * path.traction_force[..., 0] - arm_x * path.normal_force  # of the ground
    power = -torque * speed
    found = leg_work(path)
    assert (np.maximum(power, 0)[1:].sum() * dt) == pytest.approx(found.done, rel=0.01)
    assert (np.maximum(-power, 0)[1:].sum() * dt) == pytest.approx(found.taken_back, rel=0.01)


def arms(path):
    """Return x and z from each hip to the lowest point of its half circle, about level [m]."""
    lean = path.theta + path.orientation[:, 1:2]
    rolls = np.cos(lean) >= 0  # the arc's centre is ahead of the hip
    r = ROBOT.leg_radius
    x = np.where(rolls, np.cos(lean), 2 * np.cos(lean))
    z = np.where(rolls, -np.sin(lean) - 1, -2 * np.sin(lean))
    return r * x, r * z


def test_held_legs_do_no_work_and_slip_takes_what_the_body_had():
    held = SampledReference(np.array([0.0, 1.0]), np.full((2, N_LEGS), np.pi / 2))
    path = walk(
        ROBOT, held, COULOMB.table(weight=WEIGHT), duration=1.0,
        start=Start(velocity=(0.4, 0.0, 0.0)), options=DynamicsOptions(dt=0.0005),
    )  # fmt: skip
    found = leg_work(path)
    assert (found.done, found.taken_back) == (0.0, 0.0)
    assert found.slip == pytest.approx(0.5 * ROBOT.mass * 0.4**2, rel=0.02)


def test_the_work_of_parts_is_that_of_the_whole():
    path = walk(ROBOT, LEGS.reference(), COULOMB.table(weight=WEIGHT), duration=3.0)
    whole, half = leg_work(path), len(path.t) // 2
    parts = leg_work(path.part(slice(half + 1))), leg_work(path.part(slice(half, None)))
    assert sum(part.done for part in parts) == pytest.approx(whole.done)
    assert sum(part.slip for part in parts) == pytest.approx(whole.slip)


def test_a_model_without_forces_has_no_work():
    path = walk(ROBOT, LEGS.reference(), COULOMB.table(weight=WEIGHT), duration=0.1)
    assert np.isnan(leg_work(replace(path, energy=np.nan)).done)
