# SPDX-License-Identifier: MIT
"""Make command-line options of the fields of a request: the dataclass is the list of options."""

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import wraps
from inspect import Parameter
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from zebro_lab.terminal.option_display import completed

Command = Callable[..., None]


def request_command(*, first: tuple[str, ...] = ()) -> Callable[[Command], Command]:
    """Decorate a function for Typer: a parameter that is a dataclass becomes an option per field.

    Each field is annotated with its `typer.Option` or `typer.Argument`. A field that is itself a
    dataclass is replaced by its own fields; `tuple[X, ...]` is an option that may be repeated.
    Parameters of other types stay as they are. The decorated function takes all of them by name.
    Metavars, limits and their help are completed by `zebro_lab.terminal.option_display`.

    Args:
        first: Names of parameters that the help lists first, in this order; then come the others
            in the order of the function and of the fields.
    """

    def decorate(function: Command) -> Command:
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
    of = get_args(hint)[0] if get_origin(hint) is Annotated else None
    return get_origin(of) is tuple and get_args(of)[1:] == (...,)
