# SPDX-License-Identifier: MIT
"""Refuse rig data whose numbers no rig can have measured: exchanged columns, other units."""

from typing import Final

import numpy as np

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.tables.rig_columns import CANONICAL
from zebro_lab.tables.rig_table import RigTable
from zebro_lab.tables.slip_source import DISCS, SlipColumn, speed_column, surface_speed

LARGEST_RADIUS: Final = 3.0
"""Largest radius of a disc [m]; drums of tyre test benches have up to 1.7 m."""
LARGEST_SLIP: Final = 1.5
"""Size of slip from speeds that at least half of the rows keep within, even braking hard [-]."""
FRICTION: Final = (0.01, 4.0)
"""Range of the 95 % quantile of traction over normal force [-]: ice has 0.02, racing tyres 2."""

STRAY: Final = 10.0
"""Ratio of one traction force to the largest normal force that no friction explains [-]."""
_ALL_LARGE: Final = 0.75  # slip ratio above which no sweep lies as a whole
_REACHES: Final = 0.25  # slip ratio that each sweep goes below
_SLIPPING: Final = 0.02  # slip ratio beyond which traction exceeds the zero error of a load cell
_FEWEST: Final = 8  # rows that slip, to judge their sign
_OPPOSED: Final = 0.9  # share of these rows in which traction opposes slip, for an error


def require_plausible(
    table: RigTable, slip: SlipColumn, normal_force: Array, traction_force: Array
) -> tuple[str, ...]:
    """Check radii, slip ratios computed from speeds, and the ratio of the forces.

    The ratio is the 95 % quantile of the size of traction over normal force.

    Args:
        table: The table.
        slip: Slip ratios of its kept rows.
        normal_force: Normal forces, shape (n,) [N].
        traction_force: Traction forces, shape (n,) [N].

    Returns:
        Notes: where the radii are probably exchanged, and where the ratio of the forces is
        improbable, although their units are stated.

    Raises:
        DataError: A radius is above `LARGEST_RADIUS`, most slip ratios computed from speeds are
            beyond `LARGEST_SLIP`, the discs turn in opposite directions, or the ratio of the forces
            is outside `FRICTION` and the unit of one of them is not stated; or the traction opposes
            the slip, or is far beyond the largest normal force in a row.
    """
    doubts: tuple[str, ...] = ()
    if slip.column != "slip_ratio":
        _require_radii(table)
        _require_slip(table, slip.ratio)
        doubts = _exchanged_radii(table)
    _require_one_sign(table, slip.ratio, traction_force)
    ratio = float(np.quantile(np.abs(traction_force) / normal_force, 0.95))
    if FRICTION[0] <= ratio <= FRICTION[1]:
        _require_no_stray(table, normal_force, traction_force)
        return doubts
    found = (
        f"the traction force is {ratio:.2g} times the normal force, {_typical(traction_force)} to "
        f"{_typical(normal_force)} N; expected {FRICTION[0]:g} to {FRICTION[1]:g}"
    )
    unstated = [n for n in ("normal_force", table.traction) if not _is_stated(table, n)]
    if not unstated:
        return (*doubts, f"IMPROBABLE FORCES: {found}: check their units")
    raise table.raw.fault(
        f"{found}; state the unit of the forces in {table.columns.stated_in}, such as "
        + " and ".join(f'[columns.{n}] unit = "{CANONICAL[n].unit}"' for n in unstated)
        + " if it is right",
        table.required(unstated[0]).name,
    )


def _require_no_stray(table: RigTable, normal_force: Array, traction_force: Array) -> None:
    """Raise `DataError` at a traction force over `STRAY` times the largest normal force.

    It marks a missing value, such as -9999.
    """
    limit = STRAY * float(np.max(normal_force))
    header = table.required(table.traction).name
    table.require(
        table.traction,
        np.abs(traction_force) <= limit,
        lambda value: (
            f"found {value}, more than {STRAY:g} times the largest normal force, "
            f"{limit / STRAY:.3g} N; if it stands for a missing value, skip such rows with [rows] "
            f"keep, a condition on `{header}`, in {table.columns.stated_in}"
        ),
    )


def _typical(force: Array) -> str:
    """Format the median size of forces for a message."""
    return f"{np.median(np.abs(force)):.3g}"


def _is_stated(table: RigTable, name: str) -> bool:
    """Return whether file or column map state the unit of a force; recorded runs are in SI."""
    column = table.source_of(name)
    if column is None or table.raw.path.is_dir() or column.unit_stated:
        return True
    return table.raw.unit_of(column.name, CANONICAL[name].unit or "") is not None


def _require_radii(table: RigTable) -> None:
    """Raise `DataError` if a radius is above `LARGEST_RADIUS`, as of a number in mm."""
    for name in table.radii():
        largest = float(np.max(table.constant_or_column(name)))
        if largest > LARGEST_RADIUS:
            raise DataError(
                f"the radius is {largest:g} m; expected {LARGEST_RADIUS:g} m or less: a number "
                f'without a unit is in m, write "{largest:g} mm" for millimetres',
                file=table.columns.file or table.raw.path, column=name, value=largest, unit="m",
            )  # fmt: skip


def _require_slip(table: RigTable, ratio: Array) -> None:
    """Raise `DataError` if the discs turn in opposite directions in over 90 % of the rows.

    Or if the slip ratio, shape (n,), is beyond `LARGEST_SLIP` in more than half of them.
    """
    speed_leg, speed_ground = (surface_speed(table, disc) for disc in DISCS)
    opposite = float(np.mean(speed_leg * speed_ground < 0))
    beyond = float(np.mean(np.abs(ratio) > LARGEST_SLIP))
    if opposite > 0.9:
        found = f"the discs turn in opposite directions in {opposite:.0%} of the rows"
        advice = f"set sign = -1 of one of the speeds in {table.columns.stated_in}"
    elif beyond > 0.5:
        found = (
            f"the slip ratio computed from speeds and radii is beyond {LARGEST_SLIP:g} in "
            f"{beyond:.0%} of the rows, {np.median(ratio):.3g} in the middle"
        )
        advice = (
            "are the speeds exchanged, or a radius or a unit wrong? Correct "
            f"{table.columns.stated_in}"
        )
    else:
        return
    raise table.raw.fault(
        f"{found}; {advice}, or give the slip ratio itself as a column",
        table.required(speed_column(table, "leg")).name,
    )


def _exchanged_radii(table: RigTable) -> tuple[str, ...]:
    """Return a note if slip is large in nearly all rows, but would not be with the radii exchanged.

    The 5 % quantile of its size is `_ALL_LARGE` or more, and would be `_REACHES` or less.
    """
    if any(speed_column(table, disc).startswith("speed") for disc in DISCS):
        return ()
    turns = table.si("omega_ground") / table.si("omega_leg")
    ratio = table.constant_or_column("radius_ground") / table.constant_or_column("radius_leg")
    stated, exchanged = (np.quantile(np.abs(1 - turns * r), 0.05) for r in (ratio, 1 / ratio))
    if stated < _ALL_LARGE or exchanged > _REACHES:
        return ()
    return (
        f"IMPROBABLE SLIP: the slip ratios of {table.raw.path.name} are {stated:.2g} or more; with "
        f"the radii of the discs exchanged the least is {exchanged:.2g}: are radius_leg and "
        f"radius_ground exchanged in {table.columns.stated_in}?",
    )


def _require_one_sign(table: RigTable, ratio: Array, traction_force: Array) -> None:
    """Raise `DataError` if the traction is negative where slip is positive, and the reverse.

    That is if it opposes slip in a share of `_OPPOSED` of the rows with slip beyond `_SLIPPING`, of
    which there must be `_FEWEST`.
    """
    slipping = np.abs(ratio) > _SLIPPING
    opposed = ratio[slipping] * traction_force[slipping] < 0
    if len(opposed) < _FEWEST or np.mean(opposed) < _OPPOSED:
        return
    source = table.required(table.traction)
    raise table.raw.fault(
        f"the traction force opposes the slip in {np.mean(opposed):.0%} of the rows that slip; "
        f"expected both positive where the leg drives: set [columns.{table.traction}] sign = "
        f"{-1 if source.factor > 0 else 1} in {table.columns.stated_in}, or that of slip_ratio; "
        "or exchange the columns of the two speeds, if they are swapped",
        source.name,
    )
