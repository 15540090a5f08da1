# SPDX-License-Identifier: MIT
"""Complete the options of a command: metavar by type, limits checked and shown in the help."""

from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import replace
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin

from typer import BadParameter
from typer.models import ParameterInfo

from zebro_lab.terminal.limits import Limits

METAVARS: Final = {int: "N", float: "NUMBER", str: "TEXT", Path: "PATH"}
"""What the help shows for the value of an option that has no metavar of its own."""


def completed(hint: Any) -> Any:
    """Complete an annotation with a `typer.Option` or `typer.Argument`; return others unchanged.

    A missing metavar is set by the type; `min`, `max` and `Limits` are put into the help, and
    checked after parsing together with that every number is finite.

    Args:
        hint: Type annotation of a parameter or field.
    """
    if get_origin(hint) is not Annotated:
        return hint
    kind, *metadata = get_args(hint)
    info = next((each for each in metadata if isinstance(each, ParameterInfo)), None)
    if info is None:
        return hint
    info = copy(info)
    types = tuple(value_types(kind))
    if info.metavar is None and bool not in types:
        info.metavar = _metavar(types)
    if info.parser is None and (float in types or int in types):
        _limit(info, next((each for each in metadata if isinstance(each, Limits)), Limits()))
    return Annotated[kind, info]


def value_types(kind: Any) -> Iterator[Any]:
    """Yield the types of single values in an annotation, those of its choices as `Literal`s."""
    origin = get_origin(kind)
    if origin in (Union, UnionType, list, tuple):
        for each in get_args(kind):
            yield from value_types(each)
    elif kind is not type(None) and kind is not Ellipsis:
        yield kind


def _metavar(types: tuple[Any, ...]) -> str | None:
    if get_origin(types[0]) is Literal:
        return "|".join(map(str, get_args(types[0])))
    names = [METAVARS.get(each) for each in types]
    return None if None in names else " ".join(map(str, names))


def _limit(info: ParameterInfo, limits: Limits) -> None:
    """Move `min` and `max` of an option into its limits; show those in the help, and check them."""
    limits = replace(
        limits,
        least=info.min if info.min is not None else limits.least,
        most=info.max if info.max is not None else limits.most,
    )
    info.min = info.max = None
    if str(limits) and info.help:
        info.help = f"{info.help} Allowed: {limits}."
    info.callback = _check(limits, info.callback)


def _check(limits: Limits, then: Callable[..., Any] | None) -> Callable[[Any], Any]:
    def check(value: Any) -> Any:
        for number in value if isinstance(value, list | tuple) else (value,):
            if number is not None and not limits.hold(number):
                expected = str(limits) or "a finite number"
                advice = limits.advice and f"; {limits.advice}"
                raise BadParameter(f"found {number:g}; expected {expected}{advice}")
        return value if then is None else then(value)

    return check
