# SPDX-License-Identifier: MIT
"""Text of files made harmless before it is shown, on a terminal or in a page.

A label may hold an escape sequence that rewrites the screen, a newline that fakes the line of
another run, or marks of direction that reverse what is read.
"""

import re
from typing import Final

LONGEST: Final = 1000
"""Characters of a message that are shown; the middle of a longer one is left out."""

# Controls of C0 and C1, line and paragraph separators, marks of direction, invisible operators,
# the byte order mark, annotations, halves of surrogate pairs, tags. Joiners, which Persian and
# Hindi are written with, stay.
_HARMFUL = re.compile(
    "[\x00-\x1f\x7f-\x9f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e0fff]"
)


def shown(text: str) -> str:
    r"""Spell out characters that would do something other than show themselves.

    >>> shown("completed\nall well \x1b[31m")
    'completed\\nall well \\x1b[31m'
    """
    return _HARMFUL.sub(lambda match: ascii(match[0])[1:-1], text)


def shortened(text: str, longest: int = LONGEST) -> str:
    """Leave out the middle of a long text.

    >>> shortened("abcdefghij", 5)
    'ab … ij'
    """
    if len(text) <= longest:
        return text
    half = longest // 2
    return f"{text[:half]} … {text[-half:]}"
