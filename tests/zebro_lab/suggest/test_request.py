# SPDX-License-Identifier: MIT
"""A request parses its targets at once, and names all that it reads."""

from pathlib import Path

import pytest
from typer import BadParameter

from zebro_lab.suggest.request import (
    ForceText,
    ParameterText,
    SuggestRequest,
    WalkText,
    parse_target,
)


def test_a_walk_is_an_input():
    request = SuggestRequest(Path("p.toml"), Path("c"), ("friction", "walk:run"))
    assert request.inputs == (Path("p.toml"), Path("c"), Path("run"))


def test_a_target_of_no_form_is_refused():
    with pytest.raises(BadParameter, match="'force@' is no target"):
        SuggestRequest(Path("p.toml"), Path("c"), ("force@",))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("slip_stiffness", ParameterText("slip_stiffness")),
        ("force@0.05", ForceText((0.05,), None)),
        ("force@-0.1,0.2:8.5", ForceText((-0.1, 0.2), 8.5)),
        ("walk:data/run 1", WalkText(Path("data/run 1"))),
    ],
)
def test_texts_of_each_form_are_parsed(text, expected):
    assert parse_target(text) == expected


@pytest.mark.parametrize(
    "text", ["", "1", "walk:", "force", "force@", "force@a", "force@0.1,", "force@0.1:x", "a b"]
)
def test_texts_of_no_form_are_refused_with_what_is_expected(text):
    with pytest.raises(BadParameter, match=r"is no target; expected a parameter of the law"):
        parse_target(text)


@pytest.mark.parametrize("text", ["force@0", "force@nan", "force@1.5", "force@0.1,inf"])
def test_impossible_slips_are_refused(text):
    with pytest.raises(BadParameter, match="expected slip ratios of at most 1 that are not 0"):
        parse_target(text)


@pytest.mark.parametrize("load", ["0", "-1", "nan", "inf"])
def test_impossible_loads_are_refused(load):
    with pytest.raises(BadParameter, match="expected above 0"):
        parse_target(f"force@0.1:{load}")
