# SPDX-License-Identifier: MIT
"""Options of walk and predict: names that exist, and a band that can be drawn."""

from typing import get_args

import pytest
import typer

from model.walk.traction import TOE_LAWS
from model.walk_models import MODELS
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.request import BandRequest, ModelName, ModelRequest, ToeName


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


def test_a_band_has_two_draws_or_none_and_no_negative_standard_deviation():
    assert BandRequest().draws == 0
    with pytest.raises(SettingsError, match="expected 2 or more, or 0"):
        BandRequest(1)
    for options in ({"offset_sd_deg": -1.0}, {"start_sd": (0.0, -1.0, 0.0)}):
        with pytest.raises(SettingsError, match="deviations of 0 or more"):
            BandRequest(2, **options)
