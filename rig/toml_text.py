# SPDX-License-Identifier: MIT
"""Parse TOML of strangers within bounds: size, depth of nesting, and numbers that TOML allows.

This is the lowest floor that reads settings; `zebro_lab` reads its own through it, and checks what
JSON holds with `require_bounded`.
"""

import re
import tomllib
from collections.abc import Mapping
from typing import Any, Final

MOST_BYTES: Final = 4 << 20
"""Largest TOML file that is parsed; a calibration of ten thousand runs has a third of it."""
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
    level, depth = [("", document)], 0
    while level:
        if depth > DEEPEST:
            raise ValueError(f"is nested more than {DEEPEST} deep")
        for key, value in level:
            _require_plain(key, value)
        level = [inner for _, value in level for inner in _inside(value)]
        depth += 1


def _inside(value: object) -> "list[tuple[str, object]]":
    if isinstance(value, Mapping):
        return [(str(key), inner) for key, inner in value.items()]
    return [("", inner) for inner in value] if isinstance(value, list) else []


def _require_plain(key: str, value: object) -> None:
    if isinstance(value, int) and not -_LARGEST <= value < _LARGEST:
        raise ValueError(f"'{key[:60]}' is a whole number of more than 64 bits")
    for text in (key, value):
        if isinstance(text, str) and not text.isascii():
            try:
                text.encode()
            except UnicodeEncodeError as error:
                where = f"'{key.encode(errors='replace').decode()[:60]}' holds"
                raise ValueError(f"{where} half a pair of surrogates, which is no text") from error
