# SPDX-License-Identifier: MIT
"""Format numbers, such as times in a message, with enough digits that different ones differ."""

from typing import Final

_FEWEST: Final = 6  # significant digits, as of `:g`
_ALL: Final = 17  # tell any two floats apart


def format_distinct(*values: float) -> tuple[str, ...]:
    """Format numbers with the fewest significant digits, six or more, that show the differences.

    >>> format_distinct(1403715524.907143, 1403715524.907144)
    ('1403715524.907143', '1403715524.907144')
    >>> format_distinct(0.0, 29.98, 0.0)
    ('0', '29.98', '0')
    """
    different = len({float(value) for value in values})
    for digits in range(_FEWEST, _ALL):
        texts = tuple(f"{value:.{digits}g}" for value in values)
        if len(set(texts)) >= different:
            return texts
    return tuple(f"{value:.{_ALL}g}" for value in values)
