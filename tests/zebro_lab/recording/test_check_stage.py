# SPDX-License-Identifier: MIT
"""A robot and a person who watches it in, a profile out."""

import math

import pytest

from rig.clock import SYSTEM_CLOCK
from rig.errors import ProfileError
from rig.zebro.profile import load_leg_profile
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.recording import check_stage
from zebro_lab.recording.check_stage import check_zebro, latest_counts_as_targets
from zebro_lab.recording.request import CheckRequest


class Person:
    """Says that channels are wired in reverse, and that every leg turned backwards."""

    def __init__(self):
        self.held = 0

    def watch(self, channel):
        return 6 - channel, False

    def hold_toes_ahead(self):
        self.held += 1


@pytest.fixture
def quick(monkeypatch):
    """Move each leg in half the time, and wait for half as long."""
    monkeypatch.setattr("rig.zebro.check.DURATION", 0.25)
    monkeypatch.setattr("rig.zebro.check.SETTLING", 0.25)


@pytest.mark.usefixtures("quick")
def test_what_the_person_saw_is_in_the_profile(tmp_path):
    person, file = Person(), tmp_path / "mine.toml"
    checked = check_zebro(CheckRequest("sim", file), person)
    assert checked.profile.legs == (6, 5, 4, 3, 2, 1)
    assert checked.profile.sign == (-1,) * 6
    assert person.held == 1
    assert checked.lift_off is None
    assert load_leg_profile(str(file)) == checked.profile


def test_a_profile_that_is_there_is_kept_and_no_robot_moved(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("mine")
    with pytest.raises(AlreadyExists, match="choose another file with --save"):
        check_zebro(CheckRequest("sim", file), Person(), clock=SYSTEM_CLOCK)
    assert file.read_text() == "mine"


def test_a_replay_is_no_robot(tmp_path):
    with pytest.raises(ProfileError, match="replays a recording"):
        check_zebro(CheckRequest("replay:RUN", tmp_path / "mine.toml"), Person())
    assert list(tmp_path.iterdir()) == []


def test_counts_of_a_full_turn_are_the_set_point_of_none():
    class Robot:
        profile = load_leg_profile("zebro-100-serial")

        def read(self, timeout):
            from rig.device import Sample

            return [Sample(0.0, None, 0, (self.profile.counts_per_revolution, 1, 2, 3, 4, 5))]

    assert latest_counts_as_targets(Robot()) == (0, 1, 2, 3, 4, 5)


@pytest.mark.usefixtures("quick")
def test_lift_off_is_where_the_hip_is_as_high_as_at_touchdown(tmp_path, monkeypatch):
    class Measuring(Person):
        def measure_height(self, theta_deg):
            return 0.07 * math.sin(math.radians(theta_deg))

    monkeypatch.setattr(check_stage, "MOVING", 0.01)
    asked = CheckRequest("sim", tmp_path / "mine.toml", touchdown_deg=54.0)
    found = check_zebro(asked, Measuring()).lift_off
    assert math.degrees(found.theta) == pytest.approx(126.0, abs=3.6)  # of a count
    assert abs(found.mismatch) < 0.07 * math.radians(3.6)
