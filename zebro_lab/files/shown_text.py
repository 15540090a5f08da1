# SPDX-License-Identifier: MIT
"""Escape control characters in text from files before it is shown in a terminal or a page.

A label may contain an escape sequence that rewrites the screen, a newline that imitates the line of
another run, or direction marks that reverse the reading order.
"""

import re
from typing import Final

LONGEST: Final = 1000
"""Largest number of characters of a message that are shown; longer ones are truncated."""

# C0 and C1 control characters, line and paragraph separators, direction marks, invisible operators,
# the byte order mark, annotations, lone surrogates, tags. Joiners are kept: Persian and Hindi need
# them.
_HARMFUL = re.compile(
    "[\x00-\x1f\x7f-\x9f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e0fff]"
)


def shown(text: str) -> str:
    r"""Replace control, direction and invisible characters by Python escapes such as `\x1b`.

    Line breaks, tabs and lone surrogates are replaced too; zero-width joiners are kept.

    >>> shown("completed\nall well \x1b[31m")
    'completed\\nall well \\x1b[31m'
    """
    return _HARMFUL.sub(lambda match: ascii(match[0])[1:-1], text)


def shortened(text: str, longest: int = LONGEST) -> str:
    """Truncate a long string by replacing its middle with an ellipsis.

    Args:
        text: String to truncate.
        longest: Largest number of characters kept; the ellipsis with its spaces comes on top.

    >>> shortened("abcdefghij", 5)
    'ab … ij'
    """
    if len(text) <= longest:
        return text
    half = longest // 2
    return f"{text[:half]} … {text[-half:]}"
