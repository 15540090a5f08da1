# SPDX-License-Identifier: MIT
"""Options are completed by their types: metavars, limits in the help, and checks."""

from pathlib import Path
from typing import Annotated, Literal, get_args

import pytest
import typer

from zebro_lab.terminal.limits import Limits
from zebro_lab.terminal.option_display import completed, value_types


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


def test_limits_of_both_ways_to_state_them_are_shown_and_checked_in_every_number():
    given = typer.Option(min=0.0, help="Sizes.")
    hint = completed(Annotated[tuple[float, float], given, Limits(below=5)])
    info = get_args(hint)[1]
    assert info.help == "Sizes. Allowed: 0 or more and below 5."
    assert (given.min, given.help) == (0.0, "Sizes.")
    assert info.callback((0.0, 4.9)) == (0.0, 4.9)
    assert info.callback(None) is None
    for wrong in ((1.0, 5.0), (-0.1, 1.0), (float("nan"), 1.0)):
        with pytest.raises(typer.BadParameter, match="expected 0 or more and below 5"):
            info.callback(wrong)


def test_advice_on_a_number_outside_its_limits_stands_in_the_error_alone():
    hint = completed(Annotated[float, typer.Option(help="It."), Limits(above=0, advice="turn")])
    info = get_args(hint)[1]
    assert info.help == "It. Allowed: above 0."
    with pytest.raises(typer.BadParameter, match=r"^found -1; expected above 0; turn$"):
        info.callback(-1.0)


def test_numbers_without_limits_are_finite():
    info = get_args(completed(Annotated[float, typer.Option(help="It.")]))[1]
    assert info.help == "It."
    with pytest.raises(typer.BadParameter, match="found inf; expected a finite number"):
        info.callback(float("inf"))


def test_a_callback_is_called_with_what_passed_the_limits():
    given = typer.Option(callback=lambda value: value + 1, min=0, help="It.")
    assert get_args(completed(Annotated[int, given]))[1].callback(1) == 2


def test_types_are_found_below_optional_and_repeated_ones():
    assert list(value_types(tuple[Path, ...] | None)) == [Path]
