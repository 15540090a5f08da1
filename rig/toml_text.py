# SPDX-License-Identifier: MIT
"""Parse untrusted TOML with limits on size, depth of nesting and size of integers.

This is the lowest package that reads settings. `zebro_lab` parses its TOML with it, and checks
parsed JSON with `require_bounded`.
"""

import re
import tomllib
from collections.abc import Mapping
from typing import Any, Final

MOST_BYTES: Final = 1 << 20
"""Largest size of TOML that is parsed, which takes up to 3 s; a calibration of 8000 runs has
this size [bytes]."""
DEEPEST: Final = 32
"""Largest depth of nested tables and lists, and largest number of parts of a dotted key."""

_LARGEST: Final = 2**63  # of a whole number in TOML; float() and messages fail on ever longer ones
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
# Parsing time grows with the square of the number of a key's parts. A string that looks like such a
# key is rejected as well; text with 32 words that each end in a point does not occur.
_LONG_KEY = re.compile(rf"(?<![\w\"'-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{DEEPEST}}}")


def parse_toml(data: bytes) -> dict[str, Any]:
    """Parse TOML with limits on size, nesting and integers.

    Args:
        data: Content of a file, at most `MOST_BYTES`, in UTF-8 with or without a byte order mark.

    Raises:
        ValueError: The content is larger than `MOST_BYTES`, not UTF-8, not TOML, nested more than
            `DEEPEST` deep, has a key of more than `DEEPEST` dotted parts, or holds an integer
            beyond 64 bits; the message does not name the file.

    >>> parse_toml(b"mass = 2.17")
    {'mass': 2.17}
    """
    if len(data) > MOST_BYTES:
        raise ValueError(f"holds more than {MOST_BYTES >> 20} MiB, the most that is read")
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
    """Check depth of nesting, size of integers and validity of strings of a parsed document.

    Args:
        document: Tables and lists of plain values, as parsed from TOML or JSON.

    Raises:
        ValueError: The document is nested more than `DEEPEST` deep, an integer has more than 64
            bits, or a string or key holds an unpaired surrogate, which cannot be encoded.
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
    """Check a value, or keys and plain values of a table or list; return what is nested in it.

    Raises:
        ValueError: An integer has more than 64 bits, or a text an unpaired surrogate.
    """
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
                    f"the text {ascii(value)[:60]} holds an unpaired surrogate, which no file can "
                    "hold"
                ) from error
