# SPDX-License-Identifier: MIT
"""Make command-line options of the fields of a request: the dataclass is the list of options."""

import inspect
import math
from collections.abc import Callable, Iterator, Mapping
from copy import copy
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from functools import wraps
from inspect import Parameter
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin, get_type_hints

from typer import BadParameter
from typer.models import ParameterInfo


@dataclass(frozen=True)
class Range:
    """Range of a number; it stands beside the `typer.Option` in the annotation of a field.

    NaN and infinity are outside every range.

    Attributes:
        least: Smallest number of the range; None for no limit.
        most: Largest number of the range.
        above: Number that all numbers of the range exceed.
        below: Number that exceeds all numbers of the range.
        advice: What to do about a number outside; empty for nothing.

    >>> str(Range(least=90, below=360)), str(Range(above=0)), str(Range(least=1, most=6))
    ('90 or more and below 360', 'above 0', '1 to 6')
    >>> Range(above=0).hold(0.0), Range().hold(float("nan"))
    (False, False)
    """

    least: float | None = None
    most: float | None = None
    above: float | None = None
    below: float | None = None
    advice: str = ""

    def hold(self, number: float) -> bool:
        """Return whether a number is finite and within the limits."""
        return (
            math.isfinite(number)
            and (self.least is None or number >= self.least)
            and (self.most is None or number <= self.most)
            and (self.above is None or number > self.above)
            and (self.below is None or number < self.below)
        )

    def __str__(self) -> str:
        """Describe the range in words; empty without limits."""
        if self.least is not None and self.most is not None:
            return f"{self.least:g} to {self.most:g}"
        return " and ".join(self._parts())

    def _parts(self) -> Iterator[str]:
        """Yield a description of each limit."""
        if self.least is not None:
            yield f"{self.least:g} or more"
        if self.above is not None:
            yield f"above {self.above:g}"
        if self.most is not None:
            yield f"at most {self.most:g}"
        if self.below is not None:
            yield f"below {self.below:g}"


CommandFunction = Callable[..., None]
METAVARS: Final = {int: "N", float: "NUMBER", str: "TEXT", Path: "PATH"}
"""What the help shows for the value of an option that has no metavar of its own."""


def request_command(*, first: tuple[str, ...] = ()) -> Callable[[CommandFunction], CommandFunction]:
    """Decorate a function for Typer: a parameter that is a dataclass becomes an option per field.

    Each field is annotated with its `typer.Option` or `typer.Argument`. A field that is itself a
    dataclass is replaced by its own fields; `tuple[X, ...]` is an option that may be repeated.
    Parameters of other types stay as they are. The decorated function takes all of them by name.
    Metavars, limits and their help are completed by `completed`.

    Args:
        first: Names of parameters that the help lists first, in this order; then come the others
            in the order of the function and of the fields.
    """

    def decorate(function: CommandFunction) -> CommandFunction:
        hints = get_type_hints(function, include_extras=True)
        own = inspect.signature(function).parameters
        options = [each for name in own for each in _options(name, hints[name], own[name].default)]
        options.sort(key=lambda each: first.index(each.name) if each.name in first else len(first))

        @wraps(function)
        def command(**given: Any) -> None:
            function(**{name: _value(name, hints[name], given) for name in own})

        # Typer reads both.
        command.__annotations__ = {each.name: each.annotation for each in options}
        vars(command)["__signature__"] = inspect.Signature(options)
        return command

    return decorate


def _options(name: str, hint: Any, default: Any) -> Iterator[Parameter]:
    """Yield the Typer parameters for one parameter of a function: of a dataclass one per field."""
    if is_dataclass(hint):
        for field, inner in _fields(hint):
            missing = field.default is MISSING
            yield from _options(field.name, inner, Parameter.empty if missing else field.default)
        return
    if _is_repeatable(hint):
        of, *metadata = get_args(hint)
        optional = list[get_args(of)[0]] | None
        hint, default = Annotated[optional, *metadata], (None if default == () else default)
    yield Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=completed(hint))


def _value(name: str, hint: Any, given: Mapping[str, Any]) -> Any:
    """Return the value given for a parameter or field; construct its dataclass from values."""
    if is_dataclass(hint):
        values = {field.name: _value(field.name, inner, given) for field, inner in _fields(hint)}
        request: Any = hint
        return request(**values)
    return tuple(given[name] or ()) if _is_repeatable(hint) else given[name]


def _fields(request: Any) -> list[tuple[Field[Any], Any]]:
    """Return the fields of a dataclass with their resolved type hints, `Annotated` included."""
    hints = get_type_hints(request, include_extras=True)
    return [(field, hints[field.name]) for field in fields(request)]


def _is_repeatable(hint: Any) -> bool:
    """Return whether a type hint is `Annotated[tuple[X, ...], …]`: an option to be repeated."""
    of = get_args(hint)[0] if get_origin(hint) is Annotated else None
    return get_origin(of) is tuple and get_args(of)[1:] == (...,)


def completed(hint: Any) -> Any:
    """Complete an annotation with a `typer.Option` or `typer.Argument`; return others unchanged.

    A missing metavar is set by the type; a `Range` is put into the help, and checked after parsing
    together with that every number is finite.

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
        limits = next((each for each in metadata if isinstance(each, Range)), Range())
        if str(limits) and info.help:
            info.help = f"{info.help} Allowed: {limits}."
        info.callback = _check(limits, info.callback)
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
    """Return what the help shows for a value of these types: choices, or a word for each type.

    None if one of the types has no word in `METAVARS`; Typer chooses then.
    """
    if get_origin(types[0]) is Literal:
        return "|".join(map(str, get_args(types[0])))
    names = [METAVARS.get(each) for each in types]
    return None if None in names else " ".join(map(str, names))


def _check(limits: Range, then: Callable[..., Any] | None) -> Callable[[Any], Any]:
    """Return a callback for Typer that raises `BadParameter` for a number outside the limits.

    It checks each number of a list, and then calls `then`, the callback that the option had.
    """

    def check(value: Any) -> Any:
        for number in value if isinstance(value, list | tuple) else (value,):
            if number is not None and not limits.hold(number):
                expected = str(limits) or "a finite number"
                advice = limits.advice and f"; {limits.advice}"
                raise BadParameter(f"found {number:g}; expected {expected}{advice}")
        return value if then is None else then(value)

    return check
