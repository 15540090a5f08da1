# SPDX-License-Identifier: MIT
"""Make command-line options of the fields of a request: the dataclass is the list of options."""

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import wraps
from inspect import Parameter
from typing import Annotated, Any, get_args, get_origin, get_type_hints

Command = Callable[..., None]


def request_command(*, first: tuple[str, ...] = ()) -> Callable[[Command], Command]:
    """Decorate a function for Typer: a parameter that is a dataclass becomes an option per field.

    Each field is annotated with its `typer.Option` or `typer.Argument`. A field that is itself a
    dataclass is replaced by its own fields; `tuple[X, ...]` is an option that may be repeated.
    Parameters of other types stay as they are. The decorated function takes all of them by name.

    Args:
        first: Names of parameters that the help lists first, in this order; then come the others
            in the order of the function and of the fields.
    """

    def rank(parameter: Parameter) -> int:
        return first.index(parameter.name) if parameter.name in first else len(first)

    def decorate(function: Command) -> Command:
        hints = get_type_hints(function, include_extras=True)
        own = inspect.signature(function).parameters
        shown = [
            each
            for name, parameter in own.items()
            for each in _parameters(name, hints[name], parameter.default)
        ]

        @wraps(function)
        def command(**given: Any) -> None:
            function(**{name: _value(name, hints[name], given) for name in own})

        shown.sort(key=rank)
        command.__annotations__ = {each.name: each.annotation for each in shown}
        vars(command)["__signature__"] = inspect.Signature(shown)
        return command

    return decorate


def _parameters(name: str, hint: Any, default: Any) -> Iterator[Parameter]:
    """Yield the parameters that stand for one of a function, or for one field of a dataclass."""
    if is_dataclass(hint):
        for field, inner in _fields(hint):
            yield from _parameters(field.name, inner, _default(field))
        return
    if _is_repeatable(hint):
        of, *metadata = get_args(hint)
        optional = list[get_args(of)[0]] | None
        hint, default = Annotated[optional, *metadata], (None if default == () else default)
    yield Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=hint)


def _value(name: str, hint: Any, given: Mapping[str, Any]) -> Any:
    """Return the value of a parameter or field, its dataclass filled with what was given."""
    if is_dataclass(hint):
        filled: Any = hint
        return filled(
            **{each.name: _value(each.name, inner, given) for each, inner in _fields(hint)}
        )
    return tuple(given[name] or ()) if _is_repeatable(hint) else given[name]


def _fields(of: Any) -> list[tuple[Field[Any], Any]]:
    hints = get_type_hints(of, include_extras=True)
    return [(field, hints[field.name]) for field in fields(of)]


def _default(field: Field[Any]) -> Any:
    return Parameter.empty if field.default is MISSING else field.default


def _is_repeatable(hint: Any) -> bool:
    of = get_args(hint)[0] if get_origin(hint) is Annotated else None
    return get_origin(of) is tuple and get_args(of)[1:] == (...,)
