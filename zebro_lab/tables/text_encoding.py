# SPDX-License-Identifier: MIT
"""Find the encoding of a text file: UTF-8, UTF-16, or Windows-1252, which includes Latin-1."""

import codecs
from typing import Final

WINDOWS: Final = "cp1252"
_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_ZEROS = 0.3  # share of zero bytes at even or odd places from which on text is UTF-16


def possible_encodings(head: bytes) -> tuple[str, ...]:
    """Return the encodings that fit the first bytes of a file, the likelier first.

    Several only where all bytes are ASCII, so that what follows has to tell. Empty if none fits, or
    if the bytes are no text.
    """
    marked = next((name for mark, name in _MARKS if head.startswith(mark)), None)
    tried = (marked,) if marked else _by_zeros(head) or ("utf-8", WINDOWS)
    fitting = tuple(name for name in tried if _is_text(head, name))
    return fitting if head.isascii() else fitting[:1]


def decoded(head: bytes, encoding: str) -> str:
    """Return the first bytes of a file as text; a character cut at their end is left out.

    Raises:
        UnicodeDecodeError: The bytes have another encoding.
    """
    return codecs.getincrementaldecoder(encoding)().decode(head)


def _by_zeros(head: bytes) -> tuple[str, ...]:
    half = max(len(head) // 2, 1)
    if head[1::2].count(0) > _ZEROS * half:
        return ("utf-16-le",)
    return ("utf-16-be",) if head[::2].count(0) > _ZEROS * half else ()


def _is_text(head: bytes, encoding: str) -> bool:
    try:
        text = decoded(head, encoding)
    except UnicodeDecodeError:
        return False
    return not any(ord(c) < 32 and c not in "\t\r\n\f" for c in text)
