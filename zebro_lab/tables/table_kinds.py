# SPDX-License-Identifier: MIT
"""Kinds of tables, and a table that by its headers is of another kind than expected."""

from collections.abc import Collection
from typing import Final

LEGS, IMU, TRACK, RIG = "legs", "imu", "track", "rig"
KINDS: Final = (LEGS, IMU, TRACK, RIG)
"""Kinds of tables; their names are those of the sections of a `columns.toml`."""

_MARKS: Final = tuple(
    (frozenset(names.split()), kind)
    for names, kind in (
        ("normal_force traction_force", RIG),
        ("theta1 theta2 theta3 theta4 theta5 theta6", LEGS),
        ("x_m y_m", TRACK),
        ("x y", TRACK),
        ("roll pitch", IMU),  # last: tracks may have an orientation, too
        ("qw qx qy qz", IMU),
    )
)
"""Canonical names, in lower case, that together tell the kind of a table."""
_TAKERS: Final = {
    RIG: "a slip rig, which calibrate-slip takes",
    LEGS: "leg angles, which zebro-lab predict and import --legs take",
    TRACK: "a track, which zebro-lab validate and import --track take",
    IMU: "an IMU, which zebro-lab import takes as --imu, beside --legs",
}
"""What a table of each kind is of, and the commands and options that take it."""


def looks_like_other(headers: Collection[str], expected: Collection[str]) -> str:
    """Say which other kind of table the headers are of, and what takes it, for error messages.

    Only canonical names are recognised, in either case: other headers may mean anything.

    Args:
        headers: Headers of the table.
        expected: Canonical names of the columns that a table of the expected kind may have.

    Returns:
        A clause that begins with "; "; "" where no other kind is recognised.

    >>> looks_like_other(["t", "Roll", "Pitch"], ["t", "normal_force", "traction_force"])
    '; it looks like a table of an IMU, which zebro-lab import takes as --imu, beside --legs'
    """
    found, wanted = _kind(headers), _kind(expected)
    return "" if found in (None, wanted) else f"; it looks like a table of {_TAKERS[found]}"


def _kind(names: Collection[str]) -> str | None:
    lower = {name.lower() for name in names}
    return next((kind for marks, kind in _MARKS if marks <= lower), None)
