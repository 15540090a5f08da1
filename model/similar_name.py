# SPDX-License-Identifier: MIT
"""Find the known name that a misspelt one means, for the advice in error messages."""

import re
from collections.abc import Collection
from typing import Final

_LETTERS_AN_EDIT: Final = 4
"""Letters of a name for each letter that may be wrong: none in names of fewer."""
_LEAST_START: Final = 3  # letters that may stand for a longer name
_LONGEST: Final = 64  # letters; longer names are no misspelling, and comparing takes the square


def similar_name(name: str, known: Collection[str]) -> str | None:
    """Return the known name that a misspelt one most likely means; None if there is none.

    These are, in this order: a name that differs in upper and lower case, blanks, hyphens and
    underscores alone; one with a letter in four missing, added, wrong or swapped with the next; one
    that begins with the three or more letters given. A name with another number is another name.

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
    edits = {each: _edits(found, each) for each in alike if len(each) <= _LONGEST}
    near = [each for each in edits if edits[each] <= _allowed(found, each)]
    if near:
        return folded[min(near, key=lambda each: edits[each])]
    starts = [each for each in alike if len(found) >= _LEAST_START and each.startswith(found)]
    return folded[starts[0]] if starts else None


def _folded(name: str) -> str:
    return re.sub(r"[\s_-]+", "", name.casefold())


def _numbers(name: str) -> list[str]:
    return re.findall(r"\d+", name)


def _allowed(one: str, other: str) -> int:
    return max(len(one), len(other)) // _LETTERS_AN_EDIT


def _edits(one: str, other: str) -> int:
    """Count the letters to insert, delete, replace or swap with the next between two names."""
    if abs(len(one) - len(other)) > _allowed(one, other):
        return abs(len(one) - len(other))
    rows = [list(range(len(other) + 1))]
    for i, a in enumerate(one, start=1):
        row = [i]
        for j, b in enumerate(other, start=1):
            best = min(row[-1] + 1, rows[-1][j] + 1, rows[-1][j - 1] + (a != b))
            if i > 1 and j > 1 and (one[i - 2], a) == (b, other[j - 2]):
                best = min(best, rows[-2][j - 2] + 1)
            row.append(best)
        rows.append(row)
    return rows[-1][-1]
