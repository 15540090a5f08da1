# SPDX-License-Identifier: MIT
"""Switches of the thesis's model on the command line."""

from dataclasses import fields

import numpy as np
import pytest
import typer

from model.walk.thesis import ThesisOptions
from model.walk.thesis_switches import ThesisSwitches
from zebro_lab.walk.request import ModelRequest
from zebro_lab.walk.thesis_argument import SWITCHES, THESIS_HELP, named_switches, parse_thesis


def test_every_switch_has_a_name_and_the_help_lists_them_all():
    text = ",".join(SWITCHES).replace("DEG", "90")
    switches, plain = parse_thesis(text), ThesisSwitches()
    for each in fields(ThesisSwitches):
        assert getattr(switches, each.name) != getattr(plain, each.name)
    assert named_switches(switches) == tuple(text.split(","))
    assert all(name in THESIS_HELP for name in SWITCHES)


def test_the_heading_is_in_degrees():
    assert parse_thesis("heading=-45").heading == pytest.approx(-np.pi / 4)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mend-rol", "'mend-rol' is no switch; 'mend-roll'\\? there are no-height-reset, "),
        ("", "'' is no switch; there are"),
        ("mend-roll,,static-loads", "'' is no switch"),
        ("heading", "'heading' is no switch; 'heading=DEG'"),
        ("heading=north", "heading is 'north'; expected degrees from -360 to 360"),
        ("heading=nan", "expected degrees"),
        ("mend-roll=1", "is no switch"),
    ],
)
def test_what_is_no_switch_is_refused_with_those_there_are(text, said):
    with pytest.raises(typer.BadParameter, match=said):
        parse_thesis(text)


def test_switches_for_another_model_are_refused():
    switches = parse_thesis("static-loads")
    ModelRequest("thesis", "thesis", thesis=switches)
    for model in ("dynamics", "no-slip"):
        with pytest.raises(typer.BadParameter, match=f"'{model}' has none of it"):
            ModelRequest("thesis", model, thesis=switches)


def test_options_of_the_model_have_the_switches_as_the_listing_by_default():
    assert vars(ThesisOptions()).items() >= vars(ThesisSwitches()).items()
