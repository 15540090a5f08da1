# SPDX-License-Identifier: MIT
"""Numbers of a report, marked up with the file, key and value that they come from."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from markupsafe import Markup

ABSENT = Markup("–")


def look_up(document: Mapping[str, Any], keys: tuple[str | int, ...]) -> Any:
    """Return the value at a key path of a nested document, or None if a key is missing.

    Args:
        document: Nested mappings and lists.
        keys: Keys and list indices, outermost first.

    >>> look_up({"a": [{"b": 2}]}, ("a", 0, "b"))
    2
    """
    found: Any = document
    for key in keys:
        try:
            found = found[key]
        except (KeyError, IndexError, TypeError):
            return None
    return found


def number(
    document: Mapping[str, Any],
    *keys: str | int,
    file: str,
    scale: float = 1.0,
    digits: int = 3,
    rule: Callable[[float], float] | None = None,
) -> str:
    """Format a number with its origin: `<data value="0.0123" data-file=… data-key=…>12.3</data>`.

    Args:
        document: Content of the file.
        keys: Key path of the number in the document.
        file: Name of the file, for `data-file`.
        scale: Factor from the file's unit to the shown unit.
        digits: Number of significant digits shown; integers are not rounded.
        rule: What is shown of the number, before it is scaled; None for the number itself.

    Returns:
        The HTML element; a dash if the value is missing, not a number, or not finite.
    """
    value = look_up(document, keys)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return ABSENT
    path = "/".join(str(key).replace("~", "~0").replace("/", "~1") for key in keys)
    shown = value if rule is None else rule(value)
    shown = shown if scale == 1 else scale * shown  # a count stays an integer
    return Markup('<data value="{}" data-file="{}" data-key="/{}">{}</data>').format(
        repr(value), file, path, spelled(shown, digits)
    )


def spelled(value: float, digits: int = 3) -> str:
    """Format a number with a given number of significant digits; integers are not rounded.

    Args:
        value: Number to format.
        digits: Number of significant digits.

    >>> spelled(0.02084), spelled(1721.4, 4), spelled(62000), spelled(1e-7)
    ('0.0208', '1721', '62000', '1e-07')
    """
    if isinstance(value, int):
        return str(value)
    return f"{float(f'{value:.{digits}g}'):.15g}"
