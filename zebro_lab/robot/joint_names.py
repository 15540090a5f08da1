# SPDX-License-Identifier: MIT
"""Tell from a joint's name which leg it turns: by its number, or by its place on the body."""

import re
from collections.abc import Iterable
from typing import Final

from model.robot import N_LEGS

_WORDS: Final = {
    "front": "F", "fore": "F", "middle": "M", "mid": "M", "center": "M", "centre": "M",
    "rear": "R", "back": "R", "hind": "R",
}  # fmt: skip
_SIDES: Final = {"left": 0, "right": 1}
_ROWS: Final = {"F": 0, "M": 1, "C": 1, "R": 2, "B": 2, "H": 2}
_SHORT: Final = re.compile(r"([FMCRBH])([LR])|([LR])([FMCRBH])")


def legs_of_joints(names: Iterable[str]) -> dict[str, int]:
    """Return the leg of each joint whose name states it; none where two joints claim one leg.

    A name states a number from 1 to 6 after `leg` or `theta` (docs/conventions.md numbers the
    legs), or row and side in words or as in LF, FL: `leg_3`, `leg_front_left_joint`, `RM_hip`.

    Args:
        names: Names of the joints.

    >>> legs_of_joints(["leg_front_left_joint", "MR_hip", "gripper"])
    {'leg_front_left_joint': 1, 'MR_hip': 4}
    """
    told = {name: leg for name in names if (leg := _leg(name)) is not None}
    if len(set(told.values())) < len(told):
        return {}
    return told


def _leg(name: str) -> int | None:
    words = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)
    place = _place([word.lower() for word in words]) or _short_place(words)
    if place is not None:
        row, side = place
        return 2 * row + side + 1
    number = re.fullmatch(r"(?:.*_)?(?:leg|theta)_?([1-9]\d*)(?:_.*)?", name.lower())
    if number is None or not 1 <= int(number[1]) <= N_LEGS:
        return None
    return int(number[1])


def _place(words: list[str]) -> tuple[int, int] | None:
    rows = {_ROWS[_WORDS[word]] for word in words if word in _WORDS}
    sides = {_SIDES[word] for word in words if word in _SIDES}
    return (rows.pop(), sides.pop()) if len(rows) == len(sides) == 1 else None


def _short_place(words: list[str]) -> tuple[int, int] | None:
    found = [match for word in words if (match := _SHORT.fullmatch(word.upper()))]
    if len(found) != 1:
        return None
    row, side, other_side, other_row = found[0].groups()
    return _ROWS[row or other_row], "LR".index(side or other_side)
