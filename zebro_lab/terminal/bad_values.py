# SPDX-License-Identifier: MIT
"""Messages of option values that Typer cannot convert, with the value that was found."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

from typer import BadParameter

_EXPECTED: Final = {
    "float": "a number", "int": "a whole number", "bool": "true or false", "path": "a path",
}  # fmt: skip
_PREFIX: Final = "Value error, "


@contextmanager
def values_named() -> Iterator[None]:
    """Reword the errors of values that pydantic refuses: "found '2s'; expected a number".

    Raises:
        BadParameter: As raised in the body, reworded where pydantic raised it.
    """
    try:
        yield
    except BadParameter as error:
        errors = getattr(error.__cause__, "errors", None)
        if errors is not None:
            error.message = _reworded(error.message, errors()[0])
        raise


def _reworded(message: str, found: dict[str, Any]) -> str:
    kind = str(found.get("type", "")).split("_")[0]
    if kind in _EXPECTED:
        return f"found '{found.get('input')}'; expected {_EXPECTED[kind]}"
    return message.removeprefix(_PREFIX)
