# SPDX-License-Identifier: MIT
"""Format a number of things for messages."""


def counted(number: int, noun: str, plural: str | None = None) -> str:
    """Format a number with its noun, in the singular for one thing alone.

    Args:
        number: How many there are.
        noun: What there is, in the singular.
        plural: The plural, if it is not the singular with an s.

    >>> counted(1, "pose"), counted(0, "pose"), counted(2, "axis", "axes")
    ('1 pose', '0 poses', '2 axes')
    """
    return f"{number} {noun if number == 1 else plural or noun + 's'}"
