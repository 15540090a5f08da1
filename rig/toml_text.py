# SPDX-License-Identifier: MIT
"""Parse TOML of strangers within bounds: size, depth of nesting, and numbers that TOML allows.

This is the lowest floor that reads settings; `zebro_lab` reads its own through it, and checks what
JSON holds with `require_bounded`.
"""

import re
import tomllib
from collections.abc import Mapping
from typing import Any, Final

MOST_BYTES: Final = 1 << 20
"""Largest TOML file that is parsed, which takes up to 3 s; a calibration of 8000 runs has it."""
DEEPEST: Final = 32
"""Most tables and lists inside each other, and most parts of a dotted key."""

_LARGEST: Final = 2**63  # of a whole number in TOML; float() and messages fail on ever longer ones
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
# Time to parse grows with the square of a key's parts. A text that looks like such a key is refused
# with it; nobody writes 32 words with a point after each.
_LONG_KEY = re.compile(rf"(?<![\w\"'-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{DEEPEST}}}")


def parse_toml(data: bytes) -> dict[str, Any]:
    """Parse TOML.

    Args:
        data: Content of a file, at most `MOST_BYTES`, in UTF-8 with or without a byte order mark.

    Raises:
        ValueError: It is larger, no UTF-8, no TOML, nested too deeply, or holds a whole number
            beyond 64 bits; the message is one line without the file's name.

    >>> parse_toml(b"mass = 2.17")
    {'mass': 2.17}
    """
    if len(data) > MOST_BYTES:
        raise ValueError(f"holds more than {MOST_BYTES >> 20} MiB; at most that is read")
    text = data.decode("utf-8-sig")
    if _LONG_KEY.search(text):
        raise ValueError(f"a dotted key has more than {DEEPEST} parts")
    try:
        document = tomllib.loads(text)
    except RecursionError as error:
        raise ValueError(f"is nested more than {DEEPEST} deep") from error
    require_bounded(document)
    return document


def require_bounded(document: object) -> None:
    """Refuse a parsed document that is nested too deeply or whose values do not fit anywhere.

    Args:
        document: Tables and lists of plain values, as TOML and JSON have them.

    Raises:
        ValueError: It is nested more than `DEEPEST` deep, a whole number has more than 64 bits, or
            a text holds half a pair of surrogates, which no file can hold.
    """
    level: list[object] = [document]
    for _ in range(DEEPEST + 1):
        inner: list[object] = []
        for node in level:
            inner += _checked_parts(node)
        if not inner:
            return
        level = inner
    raise ValueError(f"is nested more than {DEEPEST} deep")


def _checked_parts(node: object) -> list[object]:
    """Check the plain values of a table or list, and return the tables and lists in it."""
    if isinstance(node, Mapping):
        _require_plain(*node)
        values = list(node.values())
    else:
        values = node if isinstance(node, list) else [node]
    parts: list[object] = [value for value in values if isinstance(value, dict | list)]
    if len(parts) < len(values):
        _require_plain(*values)
    return parts


def _require_plain(*values: object) -> None:
    for value in values:
        if isinstance(value, int) and not -_LARGEST <= value < _LARGEST:
            raise ValueError("holds a whole number of more than 64 bits")
        if isinstance(value, str) and not value.isascii():
            try:
                value.encode()
            except UnicodeEncodeError as error:
                raise ValueError(
                    f"the text {ascii(value)[:60]} holds half a pair of surrogates, which no file "
                    "can hold"
                ) from error
