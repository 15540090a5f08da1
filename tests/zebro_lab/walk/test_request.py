# SPDX-License-Identifier: MIT
"""Options of walk and predict: names that exist, and a band that can be drawn."""

from typing import get_args

import pytest
import typer

from model.walk.traction import TOE_LAWS
from model.walk_models import MODELS
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.request import (
    LONGEST_SLIPPING_STEP,
    LONGEST_STEP,
    BandRequest,
    ModelName,
    ModelRequest,
    ToeName,
)


def test_options_offer_the_models_and_toe_laws_that_there_are():
    assert set(get_args(ModelName)) == set(MODELS)
    assert get_args(ToeName) == TOE_LAWS


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


def test_a_band_has_two_draws_or_none_and_no_negative_standard_deviation():
    assert BandRequest().draws == 0
    with pytest.raises(SettingsError, match="expected 2 or more, or 0"):
        BandRequest(1)
    for options in ({"offset_sd_deg": -1.0}, {"start_sd": (0.0, -1.0, 0.0)}):
        with pytest.raises(SettingsError, match="deviations of 0 or more"):
            BandRequest(2, **options)
