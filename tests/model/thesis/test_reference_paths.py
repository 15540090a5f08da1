# SPDX-License-Identifier: MIT
"""The thesis's listing, rebuilt and run elsewhere: paths to be reproduced."""

import numpy as np
import pandas as pd
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.gait.suriana import suriana_reference
from model.robot import Robot
from model.thesis.legs import SwitchedLegs
from model.thesis.walk import ThesisOptions, walk_thesis
from support.chatter import sign_changes_per_second

pytestmark = pytest.mark.reference

DT = 0.001
KEPT = 10  # the reference holds every tenth step


def turning(steering, inner_deg, cycle):
    return tripod_reference(tripod_angles(np.radians(inner_deg), steering), cycle)


def straight(touchdown_deg, liftoff_deg, ground_time, flight_time):
    touchdown, liftoff = np.radians([touchdown_deg, liftoff_deg])
    return suriana_reference(
        touchdown, liftoff, ground_time=ground_time, flight_time=flight_time, turn_time=0.0
    )


def gait_of(name):
    return turning(*TURNS[name]) if name in TURNS else straight(*STRAIGHTS[name])


def legs_of(name):
    return SwitchedLegs.of(gait_of(name))


TURNS = {"a_left": (1.2, 45.0, 1.0), "b": (1.25, 45.0, 1.0), "c": (1.1, 50.0, 2.0)}
STRAIGHTS = {
    "f_TD50_LO118": (50.0, 118.0, 0.4, 0.3),
    "f_TD35_LO130": (35.0, 130.0, 0.4, 0.3),
    "g": (50.0, 118.0, 1.0, 1.0),
}
TOLERANCES = {  # m and degrees
    "a_left": (0.002, 0.2),
    "b": (0.01, 0.5),
    "c": (0.01, 0.5),
    "f_TD50_LO118": (0.002, 0.2),
    "f_TD35_LO130": (0.002, 0.2),
    "g": (0.01, 0.5),
}


def walked(shared, name):
    """Return the reference, our states after the same steps, and the forces of those steps."""
    reference = pd.read_csv(shared / f"reference/listing/{name}.csv.gz")
    duration = float(reference["t"].iloc[-1]) + DT
    path = walk_thesis(Robot(), legs_of(name), duration=duration)
    return reference, path.part(slice(1, None, KEPT)), path.part(slice(0, -1, KEPT))


@pytest.mark.parametrize("name", TOLERANCES)
def test_the_path_is_the_references(shared, name):
    reference, states, _ = walked(shared, name)
    metres, degrees = TOLERANCES[name]
    assert len(states.t) == len(reference)
    off = np.linalg.norm(states.position[:, :2] - reference[["x", "y"]], axis=1)
    assert off.max() < metres
    assert np.abs(states.position[:, 2] - reference["z"]).max() < 0.0005
    assert np.degrees(np.abs(states.yaw - reference["yaw"])).max() < degrees


@pytest.mark.parametrize("name", ["f_TD50_LO118", "f_TD35_LO130", "g"])
def test_where_no_start_is_tied_it_is_the_reference_digit_by_digit(shared, name):
    reference, states, steps = walked(shared, name)
    np.testing.assert_allclose(states.position[:, :2], reference[["x", "y"]], atol=1e-7)
    np.testing.assert_allclose(states.yaw, reference["yaw"], atol=1e-7)
    loads = reference[[f"fn{i}" for i in range(1, 7)]]
    np.testing.assert_allclose(steps.normal_force, loads, atol=1e-4)
    traction = reference[[f"ft{i}" for i in range(1, 7)]]
    np.testing.assert_allclose(steps.traction_force[:, :, 0], traction, atol=1e-3)
    kappa = reference[[f"kappa{i}" for i in range(1, 7)]].to_numpy()
    np.testing.assert_allclose(np.nan_to_num(steps.slip_ratio)[1:], kappa[1:], rtol=1e-3, atol=1e-3)


@pytest.mark.parametrize("name", TOLERANCES)
def test_legs_and_contacts_are_the_references(shared, name):
    reference, states, steps = walked(shared, name)
    theirs = reference[[f"theta{i}" for i in range(1, 7)]].to_numpy()
    np.testing.assert_allclose(states.theta, theirs, atol=1e-7)
    numbers = [int("".join(str(i + 1) for i in np.flatnonzero(c))) for c in steps.contact]
    # At the start of a turn heights tie but for rounding, and the reference flips for one step.
    assert np.array_equal(numbers[1:], reference["contact"][1:])


def test_the_slip_ratio_of_c_chatters(shared):
    path = walk_thesis(Robot(), legs_of("c"), duration=10.0)
    assert sign_changes_per_second(path) > 500


def test_shorter_steps_tend_to_the_references_limit():
    """The table of converged ends, for c; see `test_walk` for a."""
    options = ThesisOptions(dt=0.0002)
    path = walk_thesis(Robot(), legs_of("c"), duration=25.0, options=options)
    np.testing.assert_allclose(path.position[-1, :2], [1.8818, 0.7754], atol=0.001)
    assert np.degrees(path.yaw[-1]) == pytest.approx(44.79, abs=0.05)
