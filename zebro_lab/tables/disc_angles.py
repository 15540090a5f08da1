# SPDX-License-Identifier: MIT
"""Angles of the discs of a rig table, where they are recorded."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from model.arrays import Array
from model.slip.samples import DiscAngles
from zebro_lab.tables.rig_table import RigTable
from zebro_lab.tables.run_separation import Runs

ANGLES: Final = ("angle_leg", "angle_ground")
DISAGREEMENT: Final = 0.2
"""Largest relative difference between a disc's turns by its angle and by its speed [-]."""
_MOST_SURE = 0.5  # rad, largest difference allowed for fast discs, since it is wrapped to a turn
_TURNING = 1e-4  # rad, least turn between samples at which angle and speed are compared


def disc_angles(
    table: RigTable, runs: Runs, time: Array | None
) -> tuple[DiscAngles | None, tuple[str, ...]]:
    """Return the angles of the discs that are recorded, and notes on what is not used.

    Args:
        table: Rig table.
        runs: Run of each kept row.
        time: Time of each kept row, shape (n,) [s]; None without times.

    Returns:
        The angles, accumulated or wrapped; None where none are recorded, a radius is not known,
        each row is a trial, or none of those recorded can be used.

    Raises:
        DataError: A cell is no finite number, or by its angle a disc turns otherwise than by its
            speed. In a recorded run the latter gives a note, and the angle is not used; likewise
            in any table an angle that does not change.
    """
    recorded = [name for name in ANGLES if table.source_of(name)]
    if not recorded:
        return None, ()
    radii = table.radii()
    why = "each row is a trial" if table.columns.runs.each_row else ""
    why = why or ("" if len(radii) == 2 else "the radii of the discs are not known")
    if why:
        return None, (f"angles of the discs are not used: {why}",)
    angles, notes = {}, []
    for name in recorded:
        angle = table.si(name)
        problem = "it does not change" if np.ptp(angle) == 0 else _problem(table, name, runs, time)
        if problem and np.ptp(angle) > 0 and not table.raw.path.is_dir():
            raise table.raw.fault(problem, table.required(name).name)
        if problem:  # recorded runs have angles unasked
            notes.append(f"{name} is not used: {problem}")
        else:
            angles[name] = angle
    if not angles:
        return None, tuple(notes)
    return DiscAngles(
        angles.get("angle_leg"), angles.get("angle_ground"), radii["radius_leg"],
        radii["radius_ground"],
    ), tuple(notes)  # fmt: skip


def joined_angles(
    tables: Sequence[DiscAngles | None],
) -> tuple[DiscAngles | None, tuple[str, ...]]:
    """Return the angles of the discs that all tables have, and notes on those that are not used.

    Args:
        tables: Angles of each table, in the order of its samples; None of a table without.

    Returns:
        The joined angles, None if no disc has angles in all tables or their radii differ; and the
        notes.
    """
    each = [one for one in tables if one is not None]
    if not each:
        return None, ()
    if len({(one.radius_leg, one.radius_ground) for one in each}) > 1:
        return None, ("angles of the discs are not used: the tables have discs of other radii",)
    joined: dict[str, Array] = {}
    notes = []
    for disc in ("leg", "ground"):
        angles = [found for one in each if (found := getattr(one, disc)) is not None]
        if len(angles) == len(tables):
            joined[disc] = np.concatenate(angles)
        elif angles:
            notes.append(f"the angle of the {disc} disc is not used, because some tables lack it")
    if not joined:
        return None, tuple(notes)
    return replace(each[0], **({"leg": None, "ground": None} | joined)), tuple(notes)


def _problem(table: RigTable, name: str, runs: Runs, time: Array | None) -> str:
    """Describe how a disc turns otherwise by its angle than by its speed; "" where both agree.

    Turns between samples of a run are compared: the change of the angle, and the trapezoidal
    integral of the speed, by the median size of their difference, which is wrapped to a turn. The
    angle may have either sign.
    """
    speed = name.replace("angle", "omega")
    if time is None or table.source_of(speed) is None:
        return ""
    inside = np.diff(runs.index) == 0
    angle, omega = table.si(name), table.si(speed)
    expected = (0.5 * (omega[1:] + omega[:-1]) * np.diff(time))[inside]
    turned = np.diff(angle)[inside]
    turning = np.abs(expected) > _TURNING
    if not turning.any():
        return ""
    expected, turned = expected[turning], turned[turning]
    usual = float(np.median(np.abs(expected)))
    off = min(float(np.median(np.abs(_wrapped(turned - way * expected)))) for way in (1, -1))
    if off <= min(DISAGREEMENT * usual, _MOST_SURE):
        return ""
    ratio = float(np.median(np.abs(turned))) / usual
    return (
        f"the disc turns by {ratio:.3g} times what its speed '{table.required(speed).name}' says; "
        f"expected 1 within {DISAGREEMENT:g}: correct the unit of the angle (57.3 times is deg, "
        f"not rad) or of the speed, or a gear by scale, in {table.columns.stated_in}, or delete "
        "the column"
    )


def _wrapped(angle: Array) -> Array:
    """Wrap angles to -pi to pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi
