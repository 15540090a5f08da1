# SPDX-License-Identifier: MIT
"""A request's fields are the options of a command."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal, get_args

import pytest
import typer
from typer.testing import CliRunner

from zebro_lab.terminal.request_command import Range, completed, request_command


@dataclass(frozen=True)
class Lens:
    """A group of options."""

    name: Annotated[str, typer.Option("--lens", help="Its name.")] = "wide"
    sides: Annotated[tuple[int, int], typer.Option(help="Pixels.")] = (4, 3)


@dataclass(frozen=True)
class Request:
    """What is asked."""

    photos: Annotated[tuple[str, ...], typer.Argument(help="Photographs.")]
    lens: Lens = field(default_factory=Lens)
    notes: Annotated[tuple[str, ...], typer.Option("--note", help="Repeatable.")] = ()
    step: Annotated[float | None, typer.Option(help="Step [s]."), Range(least=0)] = None


def run(*arguments, first=()):
    taken = []
    app = typer.Typer(rich_markup_mode=None)

    @app.command()
    @request_command(first=first)
    def look(request: Request, dry: Annotated[bool, typer.Option("--dry")] = False) -> None:
        """Look at photographs."""
        taken.append((request, dry))

    return CliRunner().invoke(app, arguments), taken


def test_without_options_the_request_has_its_defaults():
    _, taken = run("a", "b")
    assert taken == [(Request(("a", "b")), False)]


def test_options_fill_the_request_its_groups_and_the_other_parameters():
    _, taken = run("a", "--lens", "tele", "--sides", "8", "6", "--note", "x", "--note", "y",
                   "--step", "0.5", "--dry")  # fmt: skip
    assert taken == [(Request(("a",), Lens("tele", (8, 6)), ("x", "y"), 0.5), True)]


@pytest.mark.parametrize("arguments", [(), ("a", "--step", "-1"), ("a", "--sides", "1")])
def test_wrong_usage_is_exit_2(arguments):
    result, taken = run(*arguments)
    assert (result.exit_code, taken) == (2, [])


def test_help_lists_options_as_the_fields_stand_those_named_first_before():
    def names(**options):
        text = run("--help", **options)[0].output
        assert "Look at photographs." in text
        return sorted(("--lens", "--sides", "--note", "--step", "--dry"), key=text.index)

    assert names() == ["--lens", "--sides", "--note", "--step", "--dry"]
    assert names(first=("dry", "step")) == ["--dry", "--step", "--lens", "--sides", "--note"]


@pytest.mark.parametrize(
    ("kind", "metavar"),
    [(int, "N"), (float | None, "NUMBER"), (str, "TEXT"), (list[Path] | None, "PATH"),
     (Literal["a", "b"], "a|b"), (tuple[float, int], "NUMBER N"), (bool, None)],
)  # fmt: skip
def test_a_missing_metavar_is_that_of_the_type(kind, metavar):
    info = get_args(completed(Annotated[kind, typer.Option(help="It.")]))[1]
    assert info.metavar == metavar


def test_a_given_metavar_a_parser_and_plain_types_are_kept():
    info = get_args(completed(Annotated[float, typer.Option(metavar="DEG")]))[1]
    assert info.metavar == "DEG"
    given = typer.Option(parser=float, metavar="X", help="It.")
    assert get_args(completed(Annotated[float, given]))[1].callback is None
    assert completed(int) is int
    assert completed(Annotated[int, "note"]) == Annotated[int, "note"]


def test_limits_are_shown_and_checked_in_every_number():
    given = typer.Option(help="Sizes.")
    hint = completed(Annotated[tuple[float, float], given, Range(least=0, below=5)])
    info = get_args(hint)[1]
    assert info.help == "Sizes. Allowed: 0 or more and below 5."
    assert given.help == "Sizes."
    assert info.callback((0.0, 4.9)) == (0.0, 4.9)
    assert info.callback(None) is None
    for wrong in ((1.0, 5.0), (-0.1, 1.0), (float("nan"), 1.0)):
        with pytest.raises(typer.BadParameter, match="expected 0 or more and below 5"):
            info.callback(wrong)


def test_advice_on_a_number_outside_its_limits_stands_in_the_error_alone():
    hint = completed(Annotated[float, typer.Option(help="It."), Range(above=0, advice="turn")])
    info = get_args(hint)[1]
    assert info.help == "It. Allowed: above 0."
    with pytest.raises(typer.BadParameter, match=r"^found -1; expected above 0; turn$"):
        info.callback(-1.0)


@pytest.mark.parametrize(
    ("limits", "text", "inside", "outside"),
    [
        (Range(least=90, below=360), "90 or more and below 360", (90, 359.9), (89.9, 360)),
        (Range(above=0), "above 0", (5e-324, 1e308), (0, -1)),
        (Range(least=0, most=1), "0 to 1", (0, 1), (-0.1, 1.1)),
        (Range(above=0, most=30), "above 0 and at most 30", (1, 30), (0, 30.1)),
        (Range(), "", (-1e308, 0), ()),
    ],
)
def test_limits_hold_what_they_say(limits, text, inside, outside):
    assert str(limits) == text
    assert all(map(limits.hold, inside))
    assert not any(map(limits.hold, (*outside, math.nan, math.inf, -math.inf)))
