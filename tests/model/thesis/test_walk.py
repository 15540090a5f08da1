# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.errors import DomainError, WalkError
from model.gait.direction import Direction
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import GRAVITY, Robot
from model.slip import CoulombStribeck
from model.thesis.legs import SwitchedLegs
from model.thesis.traction import THESIS_TRACTION, law_traction, table_traction
from model.thesis.walk import ThesisOptions, walk_thesis
from model.walk.no_slip import walk_no_slip
from model.walk.path import turning_radius
from model.walk.traction import VelocityCoulomb

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY


def gait(steering, *, cycle=1.0, inner_deg=45.0, direction: Direction = "left"):
    angles = tripod_angles(np.radians(inner_deg), steering)
    return tripod_reference(angles, cycle, direction=direction)


def walk(steering=1.2, *, duration=4.0, traction=THESIS_TRACTION, cycle=1.0, legs=None, **options):
    legs = legs or SwitchedLegs.of(gait(steering, cycle=cycle))
    settings = ThesisOptions(**options)
    return walk_thesis(ROBOT, legs, duration=duration, traction=traction, options=settings)


def radius(path, cycle=2.0, dt=0.001):
    strides = slice(round(cycle / dt), None, round(cycle / dt))
    return turning_radius(path.position[strides, :2], path.yaw[strides])


# --- what it computes


def test_normal_forces_sum_to_what_kinematics_asks_of_the_weight():
    path = walk()
    total = path.normal_force.sum(axis=1)
    assert np.all(total >= 0.0)
    # The hips' height over whole cycles returns, so the mean vertical force is near the weight;
    # falls at contact changes are resets, not forces.
    assert 0.8 * WEIGHT < total[1000:3000].mean() < WEIGHT


def test_three_legs_carry_and_only_they_pull():
    path = walk()
    assert np.all(path.contact.sum(axis=1) == 3)
    assert np.all(path.traction_force[~path.contact] == 0.0)
    assert np.isnan(path.slip_velocity[path.contact]).all()
    assert np.all(path.slip_velocity[~path.contact] == 0.0)
    assert np.isfinite(path.slip_ratio[path.contact]).all()


def test_the_converged_end_is_the_references():
    """The limit of short steps for Table 5-1, four seconds."""
    path = walk(dt=0.00005)
    np.testing.assert_allclose(path.position[-1, :2], [0.7322, 0.1957], atol=0.0003)
    assert np.degrees(path.yaw[-1]) == pytest.approx(30.12, abs=0.02)


# --- its faults, shown


def test_its_path_is_nearly_no_slip_kinematics():
    for steering in (1.1, 1.3):
        legs = gait(steering, cycle=2.0, inner_deg=50.0)
        slipping = walk_thesis(ROBOT, SwitchedLegs.of(legs), duration=10.0)
        rolling = walk_no_slip(ROBOT, legs, duration=10.0)
        assert radius(slipping) == pytest.approx(radius(rolling), rel=0.04)


def test_a_fifth_of_the_grip_hardly_changes_its_turn():
    slippery = THESIS_TRACTION._replace(friction=THESIS_TRACTION.friction / 5)
    grippy, icy = (walk(cycle=2.0, duration=10.0, traction=t) for t in (THESIS_TRACTION, slippery))
    assert icy.yaw[-1] == pytest.approx(grippy.yaw[-1], rel=0.01)


def test_its_speed_depends_on_the_compass():
    """Table 5-2's gait, four seconds at headings 0, 90, 180 and 270 degrees."""
    lengths = [walk(1.25, heading=np.radians(h)).length for h in (0.0, 90.0, 180.0, 270.0)]
    np.testing.assert_allclose(lengths, [0.783, 0.791, 0.777, 0.769], atol=0.001)


def test_without_reset_it_sinks_and_shorter_steps_do_not_mend_all_of_it():
    def sunk(dt):
        path = walk(1.25, duration=15.0, rule="text", dt=dt)
        second = round(1 / dt)
        return path.position[:second, 2].mean() - path.position[-second:, 2].mean()

    coarse, fine = sunk(0.001), sunk(0.0002)
    assert coarse > 0.02
    assert 0.5 < fine / coarse < 0.95


def test_with_the_slip_as_printed_a_standing_robot_runs_off_and_mended_it_stands():
    """A leg that turns back by a hair drives at full grip: Listing A.19."""
    t = np.arange(0.0, 1.001, 0.02)
    legs = SampledReference(t, gait(1.2).angles(0.5)[0] - 1e-4 * t[:, None])

    def moved(*, mend):
        options = ThesisOptions(mend_slip=mend)
        path = walk_thesis(ROBOT, legs, duration=1.0, options=options)
        return np.linalg.norm(path.position[-1, :2])

    assert moved(mend=False) > 0.1
    assert moved(mend=True) < 0.001


def test_the_automata_agree_where_hip_heights_match():
    listing, text = walk(), walk(rule="text")
    np.testing.assert_allclose(text.position[-1, :2], listing.position[-1, :2], atol=0.001)


# --- its rolls


@pytest.mark.parametrize("direction", ["left", "right"])
def test_turns_to_both_sides_lean_to_the_left(direction):
    """The inner side touches down and stands higher, so a right turn ought to roll below zero."""
    legs = SwitchedLegs.of(gait(1.2, direction=direction))
    path = walk_thesis(ROBOT, legs, duration=2.0, options=ThesisOptions(direction=direction))
    assert path.orientation[500:, 0].mean() > 0.002


# --- other legs, laws and arcs


def test_other_laws_walk_nearly_the_same():
    coulomb = law_traction(CoulombStribeck(), np.array([20.0, 0.4, 0.7, 0.1]), weight=WEIGHT)
    by_velocity = table_traction(VelocityCoulomb(0.38).table(weight=WEIGHT))
    for traction in (coulomb, by_velocity):
        path = walk(traction=traction, duration=4.0)
        np.testing.assert_allclose(path.position[-1, :2], [0.733, 0.196], atol=0.02)


# --- what it refuses


def test_a_tetrapod_is_refused_with_the_time_at_which_it_shows():
    legs = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    with pytest.raises(DomainError, match=r"legs \d and \d are .* apart at t = .*tripods only"):
        walk_thesis(ROBOT, legs, duration=3.0)


@pytest.mark.parametrize(
    "options",
    [
        {"dt": 0.0},
        {"dt": np.nan},
        {"direction": "up"},
        {"rule": "table"},
    ],
)  # fmt: skip
def test_options_that_make_no_sense_are_refused(options):
    with pytest.raises(DomainError, match="expected"):
        ThesisOptions(**options)


def test_a_walk_that_diverges_is_an_error_with_time_and_state():
    featherweight = replace(ROBOT, inertia=(1e-9, 1e-9, 1e-9))
    with pytest.raises(WalkError, match=r"diverged at t = .* s.*roll.*degrees.*m/s"):
        walk_thesis(featherweight, gait(1.2), duration=2.0)


# --- its quantities


def test_slip_ratios_are_those_of_the_speeds_that_are_kept():
    path = walk(duration=1.0, mend_slip=True)
    path = path.part(path.t > 0.1)
    toe = path.phi < 0
    ground = np.where(toe, path.hip_speed, path.contact_speed)
    ratio = np.clip((path.leg_speed - ground) / np.abs(ground), -100, 100)
    down = path.contact
    np.testing.assert_allclose(ratio[down], path.slip_ratio[down], rtol=1e-9, atol=1e-12)
    assert np.isnan(path.leg_speed[~path.contact]).all()


def test_rates_of_phi_and_of_the_state_are_derivatives():
    path = walk(1.5, duration=0.4, dt=0.0001, heading=0.5)
    steady = slice(1000, 3000)  # without a change of contacts
    assert not np.diff(path.contact[steady], axis=0).any()
    rate = np.diff(path.phi[steady], axis=0) / 0.0001
    turned = np.abs(rate) > 100  # wrapped
    np.testing.assert_allclose(rate[~turned], path.phi_rate[steady][:-1][~turned], atol=5e-4)
    state = np.column_stack([path.position, path.angles])[steady]
    moved = path.rates[steady][:-1] + 0.0001 * path.acceleration[steady][:-1]
    np.testing.assert_allclose(np.diff(state, axis=0) / 0.0001, moved, atol=1e-9)
