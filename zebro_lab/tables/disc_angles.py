# SPDX-License-Identifier: MIT
"""Angles of the discs of a rig table, where they are recorded."""

from typing import Final

import numpy as np

from model.bayes.samples import DiscAngles
from model.slip.law import Array
from zebro_lab.tables.rig_table import RigTable
from zebro_lab.tables.run_separation import Runs

ANGLES: Final = ("angle_leg", "angle_ground")
DISAGREEMENT: Final = 0.2
"""Relative difference of a disc's turn between samples, by its angle and by its speed [-]."""
_MOST_SURE = 0.5  # rad, from which a difference between wrapped angles tells, whatever the turn
_TURNING = 1e-4  # rad between samples, below which nothing is told


def disc_angles(
    table: RigTable, runs: Runs, time: Array | None
) -> tuple[DiscAngles | None, tuple[str, ...]]:
    """Return the angles of the discs that are recorded, and notes on what is not used.

    Args:
        table: Rig table.
        runs: Run of each kept row.
        time: Time of each kept row, shape (n,) [s]; None without times.

    Returns:
        The angles, accumulated or wrapped; None where none are recorded, a radius is not known, or
        each row is a trial.

    Raises:
        DataError: A cell is no finite number, or a disc turns by its angle otherwise than by its
            speed.
    """
    recorded = [name for name in ANGLES if table.source_of(name)]
    if not recorded:
        return None, ()
    radii = table.radii()
    why = "each row is a trial" if table.columns.runs.each_row else ""
    why = why or ("" if len(radii) == 2 else "the radii of the discs are not known")
    if why:
        return None, (f"angles of the discs are not used: {why}",)
    angles = {name: table.si(name) for name in recorded}
    for name, angle in angles.items():
        _require_turning(table, name, angle, runs, time)
    return DiscAngles(
        angles.get("angle_leg"), angles.get("angle_ground"), radii["radius_leg"],
        radii["radius_ground"],
    ), ()  # fmt: skip


def _require_turning(
    table: RigTable, name: str, angle: Array, runs: Runs, time: Array | None
) -> None:
    """Raise `DataError` if an angle turns otherwise than its speed says, either way round."""
    speed = name.replace("angle", "omega")
    if time is None or table.source_of(speed) is None:
        return
    inside = np.diff(runs.index) == 0
    omega = table.si(speed)
    expected = (0.5 * (omega[1:] + omega[:-1]) * np.diff(time))[inside]
    turned = np.diff(angle)[inside]
    turning = np.abs(expected) > _TURNING
    if not turning.any():
        return
    expected, turned = expected[turning], turned[turning]
    usual = float(np.median(np.abs(expected)))
    off = min(float(np.median(np.abs(_wrapped(turned - way * expected)))) for way in (1, -1))
    if off <= min(DISAGREEMENT * usual, _MOST_SURE):
        return
    ratio = float(np.median(np.abs(turned))) / usual
    source = table.required(name)
    raise table.raw.fault(
        f"the disc turns by {ratio:.3g} times what its speed '{table.required(speed).name}' says; "
        f"expected 1 within {DISAGREEMENT:g}: correct the unit of the angle (57.3 times is deg, "
        f"not rad) or of the speed, or a gear by scale, in {table.columns.stated_in}, or delete "
        "the column",
        source.name,
    )


def _wrapped(angle: Array) -> Array:
    return (angle + np.pi) % (2 * np.pi) - np.pi
