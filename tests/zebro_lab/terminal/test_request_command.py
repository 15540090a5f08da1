# SPDX-License-Identifier: MIT
"""A request's fields are the options of a command."""

from dataclasses import dataclass, field
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from zebro_lab.terminal.request_command import request_command


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
    step: Annotated[float | None, typer.Option(min=0.0, help="Step [s].")] = None


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
