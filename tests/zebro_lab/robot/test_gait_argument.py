# SPDX-License-Identifier: MIT
"""The gait a command line asks for is the gait of the model, and nonsense is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait import tripod_angles, tripod_reference
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.gait_argument import GAITS, make_gait
from zebro_lab.robot.gait_request import GaitRequest


def make(**options):
    return make_gait(GaitRequest(**options), leg_arc=np.pi)


@given(steering=st.floats(1.0, 1.8), direction=st.sampled_from(["left", "right"]))
def test_steering_is_the_models_tripod(steering, direction):
    found = make(steering=steering, direction=direction, touchdown_deg="50", cycle=1.5)
    angles = tripod_angles(np.radians(50), steering)
    expected = tripod_reference(angles, 1.5, direction=direction)
    t = np.linspace(0, 3, 50)
    np.testing.assert_array_equal(found.reference.angles(t), expected.angles(t))
    assert found.direction == direction


def test_given_angles_of_both_sides_stand():
    gait = make(touchdown_deg="50,37.8", liftoff_deg="130,138", direction="right").reference
    np.testing.assert_allclose(np.degrees(gait.touchdown), [37.8, 50] * 3)
    np.testing.assert_allclose(np.degrees(gait.liftoff), [138, 130] * 3)
    assert gait.inner == (1, 3, 5)


def test_longer_arc_lifts_off_later():
    short, long = (
        make_gait(GaitRequest(), leg_arc=np.radians(arc)).reference for arc in (180, 200)
    )
    assert np.degrees(short.liftoff[0]) == pytest.approx(117.9909, abs=1e-4)
    assert np.degrees(long.liftoff[0]) == pytest.approx(126.2796, abs=1e-4)


@pytest.mark.parametrize("name", GAITS)
def test_every_gait_turns_its_legs_by_a_turn_a_cycle(name):
    reference = make(name=name).reference
    turned = reference.angles([reference.period])[0] - reference.angles([0.0])[0]
    np.testing.assert_allclose(turned, 2 * np.pi)


def test_a_gait_may_be_given_by_its_groups_of_legs():
    gait = make(name="{3,6} < {1,4} < {2,5}", tau_flight=0.5, tau_ground=0.9, tau_double=0.1)
    assert gait.what == "{3,6} ≺ {1,4} ≺ {2,5}, straight"
    assert gait.reference.period == pytest.approx(3 * (0.5 + 0.1))
    assert gait.schedule is not None


def test_the_tetrapod_turns_by_its_times_in_its_own_cycle():
    straight, turning = make(name="tetrapod"), make(name="tetrapod", tau_turn=0.2, cycle=1.5)
    assert straight.schedule is None
    assert turning.reference.period == pytest.approx(3 * (0.5 + 0.2))
    np.testing.assert_allclose(np.degrees(turning.reference.touchdown), 45)
    flights = turning.reference.flight_time
    np.testing.assert_allclose(flights, [0.5, 0.7] * 3)


@pytest.mark.parametrize("name", ["suriana", "maxplus", "tetrapod", "{1,2} < {3,4} < {5,6}"])
def test_inner_legs_stand_longer_by_the_turn_time(name):
    reference = make(name=name, tau_turn=0.1, direction="left").reference
    stands = reference.ground_time
    np.testing.assert_allclose(stands[[0, 2, 4]] - stands[[1, 3, 5]], 0.1)


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({}, "tripod, straight"),
        ({"steering": 1.3, "direction": "right"}, "tripod, s = 1.3, right"),
        ({"name": "suriana", "tau_turn": 0.1}, "suriana, tau_p = 0.1 s, left"),
        ({"name": "maxplus"}, "max-plus, straight"),
        ({"name": "tetrapod"}, "tetrapod"),
        ({"name": "buehler"}, "Buehler clock"),
    ],
)
def test_gait_is_named_by_what_sets_it_apart(options, what):
    assert make(**options).what == what


FAULTS = {
    "unknown gait": ({"name": "trot"}, r"'trot' is not a gait"),
    "option of another gait": (
        {"name": "tetrapod", "steering": 1.1}, r"--steering: does not apply to gait 'tetrapod'",
    ),
    "option of another gait, groups": (
        {"name": "{1,2,3} < {4,5,6}", "cycle": 2.0}, r"--cycle: does not apply to gait",
    ),
    "a leg is missing": ({"name": "{1,2,3} < {4,6}"}, r"^--gait: leg 5 is missing"),
    "seven legs": ({"name": "{1,2,3} < {4,5,6,7}"}, r"^--gait: .* has 7 legs; the robot has 6"),
    "no brace": ({"name": "{1,2,3,4,5,6"}, r"^--gait: .* is not a group"),
    "no number": ({"touchdown_deg": "50,x"}, r"--touchdown-deg: '50,x' is not an angle"),
    "three angles": ({"liftoff_deg": "1,2,3"}, r"--liftoff-deg: '1,2,3' is not an angle"),
    "empty angle": ({"touchdown_deg": ""}, r"--touchdown-deg: '' is not an angle"),
    "infinite angle": ({"touchdown_deg": "inf"}, r"--touchdown-deg: 'inf' is not an angle"),
    "radians": (
        {"touchdown_deg": "0.87"}, r"--touchdown-deg: found 0.87, which is .* write 49.85$",
    ),
    "one angle in radians": ({"liftoff_deg": "130,2.4"}, r"--liftoff-deg: .* in radians"),
    "two angles for one": (
        {"name": "buehler", "touchdown_deg": "50,40"}, r"this gait takes one, for all legs",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("options", "message"), FAULTS.values(), ids=FAULTS)
def test_fault_names_the_option(options, message):
    with pytest.raises(SettingsError, match=message):
        make(**options)


@pytest.mark.parametrize(
    "options",
    [
        {"steering": 9.0},
        {"liftoff_deg": "40"},
        {"cycle": -1.0},
        {"name": "suriana", "tau_turn": -0.1},
        {"name": "buehler", "cycle": 1.0, "tau_ground": 2.0},
    ],
)
def test_impossible_gait_is_refused(options):
    with pytest.raises(DomainError):
        make(**options)
