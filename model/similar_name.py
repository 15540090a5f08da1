# SPDX-License-Identifier: MIT
"""Suggest the known name that a misspelt one means, for the advice in error messages."""

import difflib
import re
from collections.abc import Collection
from typing import Final

_LIKENESS: Final = 0.75  # of difflib: `odrer` is `order` (0.8), `lateral_force` another (0.7)
_LEAST_START: Final = 3  # letters that may stand for a longer name
_LONGEST: Final = 64  # letters; longer names are no misspelling, and comparing takes the square
_LISTED: Final = 15  # names a message lists before it says how many more there are


def similar_name(name: str, known: Collection[str]) -> str | None:
    """Return the known name that a misspelt one most likely means; None if there is none.

    Looked for are, in this order: a name that differs in upper and lower case, blanks, hyphens and
    underscores alone; the most similar by `difflib`; one that begins with the three or more letters
    given. A name with another number is another name.

    Args:
        name: The unknown name.
        known: All known names.

    >>> similar_name("normal_froce", ["traction_force", "normal_force"])
    'normal_force'
    >>> similar_name("theta1", ["theta2", "theta3"])
    """
    found, folded = _folded(name), {_folded(each): each for each in reversed(list(known))}
    if found in folded:
        return folded[found]
    if len(found) > _LONGEST:
        return None
    alike = [each for each in reversed(folded) if _numbers(each) == _numbers(found)]
    near = difflib.get_close_matches(found, alike, n=1, cutoff=_LIKENESS)
    starts = [each for each in alike if len(found) >= _LEAST_START and each.startswith(found)]
    return folded[(near + starts)[0]] if near or starts else None


def nearest(name: str, known: Collection[str]) -> str:
    """Suggest the known name most similar to an unknown one.

    Args:
        name: The unknown name.
        known: All known names.

    Returns:
        Text with the name that was likely meant, if any (`similar_name`), and up to 15 of the known
        ones in their order, with the number of the others.

    >>> nearest("normal_froce", ["normal_force", "t"])
    "did you mean 'normal_force'? known: 'normal_force', 't'"
    """
    near = similar_name(name, known)
    listing = ", ".join(f"'{candidate}'" for candidate in list(known)[:_LISTED])
    listing += f" and {len(known) - _LISTED} more" if len(known) > _LISTED else ""
    return (f"did you mean '{near}'? " if near else "") + f"known: {listing}"


def _folded(name: str) -> str:
    """Return a name in lower case, without blanks, hyphens and underscores."""
    return re.sub(r"[\s_-]+", "", name.casefold())


def _numbers(name: str) -> list[str]:
    """Return all numbers in a name, as text, in their order."""
    return re.findall(r"\d+", name)
