# SPDX-License-Identifier: MIT
"""Options of walk and predict: names that exist, steps short enough."""

from pathlib import Path
from typing import get_args

import pytest
import typer

from model.thesis.tripod import RULES
from model.walk_models import MODELS
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.gait_request import GaitRequest
from zebro_lab.terminal.picture_options import parse_instants
from zebro_lab.walk.request import (
    LONGEST_SLIPPING_STEP,
    LONGEST_STEP,
    BandRequest,
    ModelName,
    ModelRequest,
    PictureRequest,
    RuleName,
    WalkRequest,
)
from zebro_lab.workers import WorkersRequest


def test_a_band_has_two_draws_or_none_and_no_negative_standard_deviation():
    assert BandRequest().draws == 0
    with pytest.raises(SettingsError, match="expected 2 or more, or 0"):
        BandRequest(1)
    with pytest.raises(SettingsError, match="--offset-sd-deg: expected 0 or more"):
        BandRequest(2, offset_sd_deg=-1.0)


def test_a_scheduler_without_draws_to_share_is_wrong_usage():
    address = "tcp://127.0.0.1:8786"
    assert BandRequest(2, scheduler=address).workers == WorkersRequest(scheduler=address)
    with pytest.raises(SettingsError, match="--scheduler: hands the draws of a band"):
        BandRequest(scheduler=address)


def test_times_of_snapshots_without_figures_are_refused():
    with pytest.raises(typer.BadParameter, match="--figures too"):
        PictureRequest(at=parse_instants("1,2"))
    assert PictureRequest(True, parse_instants("1,2")).snapshots == (1.0, 2.0)


def test_options_offer_the_models_that_there_are():
    assert set(get_args(ModelName)) == set(MODELS)


def test_what_the_thesis_model_follows_is_refused_with_other_models():
    assert get_args(RuleName) == RULES
    for model in MODELS:
        if model != "thesis":
            with pytest.raises(typer.BadParameter, match="give --model thesis too"):
                WalkRequest(duration=1.0, model=ModelRequest("thesis", model), thesis="text")


@pytest.mark.parametrize(
    ("gait", "needed"),
    [("tripod", True), ("tetrapod", False), ("{1,4} < {2,5} < {3,6}", False)],
)
def test_the_thesis_model_needs_a_slip_law_for_its_dynamics_only(gait, needed):
    request = WalkRequest(GaitRequest(gait), 1.0, model=ModelRequest(model="thesis"))
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


@pytest.mark.parametrize("model", [name for name in MODELS if name != "dynamics"])
def test_models_of_level_ground_refuse_another(model):
    with pytest.raises(SettingsError, match=f"--ground|'{model}'"):
        ModelRequest("thesis", model, ground=Path("ground.toml"))
