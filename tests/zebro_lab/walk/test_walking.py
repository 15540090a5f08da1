# SPDX-License-Identifier: MIT
"""A model walks leg angles as asked, or says in one line what it needs."""

import numpy as np
import pytest

from model.gait.steering import tripod_angles, tripod_reference
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.thesis_curve import thesis_curve
from zebro_lab.calibration.slip_argument import NamedSlip
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.request import ModelRequest
from zebro_lab.walk.walking import MOST_STEPS, WalkedLegs, walk_with

GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.0), 2.0)


def walked(*, duration=1.0, **options):
    request = ModelRequest(**options)
    return walk_with(request, RobotFile(), WalkedLegs(GAIT, duration, "a tripod"))


def test_a_walk_is_titled_by_what_walked_and_how_it_slipped():
    found = walked(slip="coulomb:0.4")
    assert found.path.length > 0.02
    assert found.title == "a tripod, model 'dynamics', slip coulomb:0.4"


def test_a_model_that_slips_needs_a_law_and_one_that_does_not_leaves_it_out():
    with pytest.raises(SettingsError, match="--slip"):
        walked()
    found = walked(model="no-slip", slip="coulomb:0.4")
    assert found.slip is None
    assert "has no slip" in found.notes[0]


def test_the_thesis_s_model_says_what_to_do_with_a_curve_of_another_definition(monkeypatch):
    other = SlipCurve(**{**vars(thesis_curve()), "definition": SlipDefinition.TRAVEL})
    named = NamedSlip(other, "real", "calibration")
    monkeypatch.setattr("zebro_lab.walk.walking.parse_slip", lambda text: named)
    with pytest.raises(SettingsError, match="--slip-definition material"):
        walked(model="thesis", slip="calibration")


@pytest.mark.parametrize("options", [{"dt": 0.0}, {"dt": 0.5 / MOST_STEPS}])
def test_steps_that_make_no_walk_or_too_long_a_one_are_an_error(options):
    with pytest.raises(SettingsError, match="--duration, --dt"):
        walked(slip="coulomb:0.4", **options)


def test_a_step_longer_than_the_model_s_is_noted():
    assert any("legs slip too much" in n for n in walked(slip="coulomb:0.4", dt=0.005).notes)
