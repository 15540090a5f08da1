# SPDX-License-Identifier: MIT
"""`robot.toml` read back, and every way in which it may describe no robot."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.robot import Robot
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.robot.marker_print import MarkerPrint
from zebro_lab.robot.robot_file import Marker, RobotFile, read_robot_file, render_robot_file


@pytest.fixture
def read(tmp_path):
    """Return a reader of a robot.toml with the given text."""

    def reader(text: str) -> RobotFile:
        file = tmp_path / "robot.toml"
        file.write_text(text)
        return read_robot_file(file)

    return reader


def test_empty_file_is_the_sources_robot(read):
    found = read("")
    assert_same_robot(found.robot, Robot())
    assert found.leg_sign == (1, 1, 1, 1, 1, 1)
    assert found.marker is None


def test_an_unknown_limit_of_leg_speed_is_shown_by_an_example():
    assert "# speed_limit_deg_per_s = 400.0 " in render_robot_file(RobotFile())


def test_units_are_converted_and_degrees_read(read):
    found = read('mass = "2170 g"\n[legs]\nradius = "3.5 cm"\narc_deg = 200\n'
                 "offset_deg = [0, 0, -5, 0, 0, 0]\nsign = [1, -1, 1, -1, 1, -1]\n"
                 '[hips]\n3 = [0.0, "120 mm", 0.0]\n')  # fmt: skip
    assert found.robot.mass == pytest.approx(2.17)
    assert found.robot.leg_radius == pytest.approx(0.035)
    assert found.robot.leg_arc == pytest.approx(np.radians(200))
    assert found.robot.leg_offset[2] == pytest.approx(np.radians(-5))
    assert found.robot.hips[2, 1] == pytest.approx(0.12)
    assert found.leg_sign == (1, -1, 1, -1, 1, -1)


lengths = st.floats(0.01, 2.0)
angles = st.floats(-10.0, 10.0)
places = st.floats(-3.0, 3.0)


@given(
    mass=lengths, radius=lengths, arc=st.floats(100, 350),
    offset=st.lists(angles, min_size=6, max_size=6),
    sign=st.tuples(*[st.sampled_from((1, -1))] * 6),
    inertia=st.none() | st.tuples(lengths, lengths, lengths),
    marker=st.none() | st.builds(Marker, st.tuples(places, places, places),
                                 st.tuples(angles, angles, angles), st.none() | lengths,
                                 st.builds(MarkerPrint, st.sampled_from(("4x4_50", "a\"b")),
                                           st.integers(0, 49), lengths)),
)  # fmt: skip
def test_what_is_written_is_read_back(
    mass, radius, arc, offset, sign, inertia, marker, tmp_path_factory
):
    robot = Robot(mass=mass, leg_radius=radius, leg_arc=np.radians(arc), inertia=inertia,
                  leg_offset=np.radians(offset))  # fmt: skip
    file = tmp_path_factory.mktemp("robot") / "robot.toml"
    file.write_text(render_robot_file(RobotFile(robot, sign, marker)))
    found = read_robot_file(file)
    assert_same_robot(found.robot, robot)
    assert found.leg_sign == sign
    assert (found.marker is None) == (marker is None)
    if found.marker is not None and marker is not None:
        np.testing.assert_allclose(found.marker.position, marker.position, rtol=1e-9)
        np.testing.assert_allclose(found.marker.roll_pitch_yaw, marker.roll_pitch_yaw, atol=1e-9)
        assert found.marker.height == (marker.height and pytest.approx(marker.height))
        assert found.marker.printed.dictionary == marker.printed.dictionary
        assert found.marker.printed.number == marker.printed.number
        assert found.marker.printed.side == pytest.approx(marker.printed.side)


def assert_same_robot(found: Robot, expected: Robot) -> None:
    for field in dataclasses.fields(Robot):
        a, b = getattr(found, field.name), getattr(expected, field.name)
        if b is None:
            assert a is None
        else:
            np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-12, err_msg=field.name)


FAULTS = {
    "no TOML": ("mass 2", "cannot be read as TOML"),
    "unknown key": ("mas = 2.0", "mas: unknown key; did you mean 'mass'?"),
    "seventh hip": ("[hips]\n7 = [0, 0, 0]", "hips.7: unknown key"),
    "negative mass": ("mass = -1.0", "mass is -1 kg; expected more than zero"),
    "five offsets": ("[legs]\noffset_deg = [0, 0, 0, 0, 0]", "expected a list of 6"),
    "sign of two": ("[legs]\nsign = [1, 1, 2, 1, 1, 1]", "expected a list of 6 signs, each 1"),
    "arc beyond a circle": ("[legs]\narc_deg = 400", "leg_arc is 400 degrees"),
    "left hip on right": ("[hips]\n1 = [0.1, -0.1, 0]", "more than 0, as leg 1 is on the left"),
    "flat hip": ("[hips]\n1 = [0, 0]", "hips.1: found [0, 0]; expected a list of 3"),
    "marker nowhere": ("[marker]\nheight = 0.1", "marker.position: is missing"),
    "marker below ground": ("[marker]\nposition = [0, 0, 0]\nheight = -1", "height: is -1 m;"),
    "marker of no size": ("[marker]\nposition = [0, 0, 0]\nside = 0", "marker.side: is 0 m"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), FAULTS.values(), ids=FAULTS)
def test_fault_is_one_line_that_names_file_and_key(text, message, read):
    with pytest.raises(SettingsError) as caught:
        read(text)
    assert message in str(caught.value)
    assert "robot.toml" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[legs]\nradius = 35", r'radius: is 35 m, .* at most 3 m .* "35 mm" \(or "35 m"\)$'),
        ('[legs]\nradius = "35"', r'radius: is 35 m, .* "35 mm"'),
        ("mass = 2170", r'mass: is 2170 kg, .* at most 100 kg .* "2170 g"'),
        ("[marker]\nposition = [0, 0, 0]\nheight = 80", r'height: is 80 m, .* "80 mm"'),
    ],
)
def test_an_improbable_number_without_a_unit_is_asked_about(text, message, read):
    with pytest.raises(SettingsError, match=message):
        read(text)


def test_an_improbable_size_with_its_unit_is_taken(read):
    found = read('mass = "2170 kg"\n[legs]\nradius = "35 m"\n')
    assert (found.robot.mass, found.robot.leg_radius) == (2170, 35)


def test_missing_file_says_how_to_start_one(tmp_path):
    with pytest.raises(NotFound, match="--kind robot"):
        read_robot_file(tmp_path / "robot.toml")
