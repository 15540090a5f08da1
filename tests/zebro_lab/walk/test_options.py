# SPDX-License-Identifier: MIT
"""Options offer the models that there are, and a model that slips needs a slip law."""

import pytest
import typer

from model.walk_models import MODELS
from zebro_lab.robot.gait_argument import GAITS
from zebro_lab.walk import options as walk_options
from zebro_lab.walk.command import GaitName


def test_options_offer_what_there_is():
    assert {name.value for name in walk_options.Model} == set(MODELS)
    assert {name.value for name in GaitName} == set(GAITS)


@pytest.mark.parametrize("model", walk_options.Model)
def test_a_slip_law_is_needed_by_the_models_that_slip(model):
    walk_options.require_slip(model, "thesis")
    if MODELS[model.value].slips:
        with pytest.raises(typer.BadParameter, match=f"legs slip in the model '{model.value}'"):
            walk_options.require_slip(model, None)
    else:
        walk_options.require_slip(model, None)
