# SPDX-License-Identifier: MIT
"""Options of walk and predict: names that exist, steps short enough."""

from typing import get_args

import pytest
import typer

from model.contact.detection import DETECTIONS
from model.contact.tripod import AUTOMATA
from model.walk.thesis import SWITCHES
from model.walk.traction import TOE_LAWS
from model.walk_models import MODELS
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.gait_request import GaitRequest
from zebro_lab.walk.request import (
    DETECTED,
    LONGEST_SLIPPING_STEP,
    LONGEST_STEP,
    AutomatonName,
    ModelName,
    ModelRequest,
    SwitchName,
    ToeName,
    WalkRequest,
)


def test_options_offer_the_models_and_toe_laws_that_there_are():
    assert set(get_args(ModelName)) == set(MODELS)
    assert get_args(ToeName) == TOE_LAWS


def test_options_offer_the_thesis_automata_and_switches():
    assert get_args(AutomatonName) == (*AUTOMATA, *DETECTIONS)
    assert get_args(SwitchName) == SWITCHES
    assert DETECTED == DETECTIONS


@pytest.mark.parametrize("model", [name for name in MODELS if name != "thesis"])
def test_options_of_the_thesis_model_are_refused_with_others(model):
    with pytest.raises(SettingsError, match=f"--automaton: found 'table' .*'{model}'"):
        ModelRequest("thesis", model, automaton="table")
    with pytest.raises(typer.BadParameter, match=f"'{model}' follow the gait's angles"):
        WalkRequest(duration=1.0, model=ModelRequest("thesis", model), switch_at="angle")


@pytest.mark.parametrize(
    ("gait", "automaton", "needed"),
    [("tripod", None, True), ("tetrapod", None, False), ("{1,4} < {2,5} < {3,6}", None, False),
     ("tripod", "events", False), ("tetrapod", "table", True)],
)  # fmt: skip
def test_the_thesis_model_needs_a_slip_law_for_its_dynamics_only(gait, automaton, needed):
    model = ModelRequest(model="thesis", automaton=automaton)
    request = WalkRequest(GaitRequest(gait), 1.0, model=model)
    if needed:
        with pytest.raises(typer.BadParameter, match="'thesis'"):
            request.require_slip()
    else:
        request.require_slip()


@pytest.mark.parametrize("model", MODELS)
def test_a_slip_law_is_needed_by_the_models_that_slip(model):
    ModelRequest("thesis", model).require_slip()
    if MODELS[model].slips:
        with pytest.raises(typer.BadParameter, match=model):
            ModelRequest(model=model).require_slip()
    else:
        ModelRequest(model=model).require_slip()


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("dt", [0.03, 1.0])
def test_a_step_that_skips_contacts_is_refused_with_the_longest_one(model, dt):
    longest = LONGEST_SLIPPING_STEP if MODELS[model].slips else LONGEST_STEP
    with pytest.raises(
        SettingsError, match=f"--dt: found {dt:g} s; expected at most {longest:g} s .*'{model}'"
    ):
        ModelRequest("thesis", model, dt=dt)
    assert ModelRequest("thesis", model, dt=longest).dt == longest
