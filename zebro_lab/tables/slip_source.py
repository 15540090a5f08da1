# SPDX-License-Identifier: MIT
"""Slip ratio of a rig table: given with its definition, or computed from the disc speeds."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.slip.definition import RANGES, SlipDefinition, convert_slip, is_possible, slip_ratio
from zebro_lab.files.errors import DataError
from zebro_lab.tables.columns import MappedColumn
from zebro_lab.tables.rig_columns import parse_definition
from zebro_lab.tables.rig_table import RigTable

DISCS = ("leg", "ground")
_SLIP_NOISE = 0.1  # margin for noise beyond the limits of slip; values in percent exceed it by far
_COMPARED = 0.9  # share of rows whose slip by the speeds is compared with the stated one
_CONTRADICTS = 3.0  # ratio of the deviations from two definitions beyond which one is the other
_LEAST_DIFFERENCE = 0.002  # of slip ratios, below which definitions are not told apart
_AGREES = 0.2  # largest deviation from the right definition, over the spread of slip


@dataclass(frozen=True)
class SlipColumn:
    """Slip ratio of every kept row, and how it was obtained.

    Attributes:
        ratio: Slip ratio in `definition`, shape (n,) [-].
        definition: Slip definition of `ratio`.
        column: Canonical column to name in error messages: `slip_ratio`, or the leg's speed.
        origin: Description of how the slip ratio was obtained, for a note.
    """

    ratio: Array
    definition: SlipDefinition
    column: str
    origin: str


def slip(table: RigTable) -> SlipColumn:
    """Return the slip ratio: the given one if its definition is known, else from disc speeds.

    A slip ratio without a definition is an error if the column map names it or there are no disc
    speeds; else it is ignored, and the `material` slip ratio computed from the speeds and radii.

    Raises:
        DataError: The table has neither or one speed alone; the definition of a given slip ratio is
            not stated or stated differently; a value is over 0.1 out of range or not finite; a
            radius is missing, given twice or not positive; or the leg disc stands still.
        SettingsError: The column `slip_definition` has an unknown name.
    """
    given = table.source_of("slip_ratio")
    names = [speed_column(table, disc) for disc in DISCS]
    speeds = all(table.source_of(name) for name in names)
    definition = _given_definition(table) if given else None
    mapped = "slip_ratio" in table.columns.columns
    if given and (definition or mapped or not speeds):
        return _given_slip(table, given, definition, speeds=speeds)
    if speeds:
        return _slip_from_speeds(table, unused=given)
    if any(table.source_of(name) for name in names):
        for name in names:
            table.required(name)
    what = "slip ratio with its definition, or of omega_leg and omega_ground with the radii,"
    raise table.columns.missing(table.raw, "slip_ratio", what=what)


def speed_column(table: RigTable, disc: str) -> str:
    """Return the canonical column of the speed of a disc, "leg" or "ground": surface or angular."""
    return f"speed_{disc}" if table.source_of(f"speed_{disc}") else f"omega_{disc}"


def surface_speed(table: RigTable, disc: str) -> Array:
    """Return the speed of the surface of a disc, "leg" or "ground", at the contact, (n,) [m/s].

    Raises:
        DataError: A cell is not a finite number; or there is the angular speed without a radius.
    """
    name = speed_column(table, disc)
    values = table.si(name)
    return values if name[:5] == "speed" else values * table.constant_or_column(f"radius_{disc}")


def converted(table: RigTable, slip_column: SlipColumn, target: SlipDefinition) -> SlipColumn:
    """Convert slip ratios to another definition; those that have it are returned unchecked.

    Args:
        table: Table that the slip ratios were read from, for error messages.
        slip_column: Slip ratios with their definition.
        target: Definition to convert to.

    Raises:
        DataError: A slip ratio is outside the range of its definition, or infinite in the target.
    """
    ratio, source, column = slip_column.ratio, slip_column.definition, slip_column.column
    if source is target:
        return slip_column
    possible = is_possible(ratio, source)
    first = float(ratio[np.argmin(possible)])
    table.require(
        column,
        possible,
        lambda _: (
            f"the slip ratio {first:.4g} is impossible for '{source}', outside {RANGES[source]}; "
            "check the definition, or leave such rows out"
        ),
    )
    values = convert_slip(ratio, source, target)
    infinite = float(ratio[np.argmin(np.isfinite(values))])
    table.require(
        column,
        np.isfinite(values),
        lambda _: (
            f"the '{source}' slip ratio {infinite:g} is infinite in the definition "
            f"'{target}'; skip such rows with [rows] keep in {table.columns.stated_in}"
        ),
    )
    return SlipColumn(values, target, column, f"{slip_column.origin}, converted to {target}")


def _given_definition(table: RigTable) -> SlipDefinition | None:
    """Return the slip definition by the column map or by a column of the table; None without both.

    Raises:
        DataError: The column has two definitions, or another one than the column map.
        SettingsError: The column has an unknown definition.
    """
    mapped = table.columns.columns.get("slip_ratio")
    stated = mapped.definition if mapped else None
    column = table.source_of("slip_definition")
    if column is None:
        return stated
    texts = table.texts("slip_definition")
    differing = texts != texts[0]
    index = int(table.rows[np.argmax(differing)] if differing.any() else table.rows[0])
    if differing.any():
        raise table.raw.fault(
            f"the file holds two slip definitions, '{texts[0]}' and "
            f"'{texts[np.argmax(differing)]}'; write one file for each",
            column.name,
            index,
        )
    found = parse_definition(texts[0], file=table.raw.path, key=column.name)
    if stated not in (None, found):
        raise table.raw.fault(
            f"the slip definition is '{found}' in this column and '{stated}' in "
            f"{table.columns.file}; correct one of them",
            column.name,
            index,
        )
    return found


def _given_slip(
    table: RigTable, given: MappedColumn, definition: SlipDefinition | None, *, speeds: bool
) -> SlipColumn:
    """Return the slip ratio in the table, as its column gives it.

    Raises `DataError` if its definition is None or a value is impossible for it. `speeds` tells
    whether the table also has disc speeds, which are then noted as not used.
    """
    if definition is None:
        raise table.raw.fault(
            f"the definition of the slip ratio is not known; state in {table.columns.stated_in} "
            "what it is divided by: [columns.slip_ratio] definition = one of "
            f"{', '.join(SlipDefinition)}",
            given.name,
        )
    ratio = table.si("slip_ratio")
    _require_possible(table, ratio, definition)
    if speeds:
        _require_agreement(table, ratio, definition)
    unused = "; the columns of disc speeds are not used" if speeds else ""
    origin = f"as given in '{given.name}', definition {definition}{unused}"
    return SlipColumn(ratio, definition, "slip_ratio", origin)


def _require_possible(table: RigTable, ratio: Array, definition: SlipDefinition) -> None:
    """Raise `DataError` if a slip ratio is beyond its definition's range by over `_SLIP_NOISE`.

    Noise may put a measured slip ratio past its limit.
    """
    inner = np.sign(ratio) * np.maximum(np.abs(ratio) - _SLIP_NOISE, 0)
    table.require(
        "slip_ratio",
        is_possible(inner, definition),
        lambda value: (
            f"the slip ratio is {value}, impossible for the definition '{definition}' "
            f"(range {RANGES[definition]}); check in {table.columns.stated_in} definition, sign "
            'and unit = "%"'
        ),
    )


def _require_agreement(table: RigTable, ratio: Array, definition: SlipDefinition) -> None:
    """Raise `DataError` if by the speeds of the same rows a slip ratio has another definition.

    Of each definition, slip by the speeds is compared with the given one, apart from a constant,
    which a wrong ratio of the radii would cause, by `_COMPARED` of the rows. Speeds that cannot be
    used are not compared.
    """
    try:
        leg, ground = (surface_speed(table, disc) for disc in DISCS)
    except DataError:
        return
    moving = (leg != 0) & (ground != 0)
    if not moving.any():
        return
    off = {d: _spread((ratio - slip_ratio(leg, ground, d))[moving]) for d in SlipDefinition}
    best = min(off, key=lambda each: off[each])
    agrees = off[best] < _AGREES * _spread(ratio)
    if agrees and off[definition] > max(_CONTRADICTS * off[best], _LEAST_DIFFERENCE):
        raise table.raw.fault(
            f"the slip ratio is stated as '{definition}', but differs by {off[definition]:.2g} "
            f"from such slip by the speeds of the same rows, from '{best}' by {off[best]:.2g}; "
            f'state definition = "{best}" in {table.columns.stated_in}, or map only the slip ratio '
            "or only the speeds, if the others are of something else",
            table.required("slip_ratio").name,
        )


def _spread(values: Array) -> float:
    """Return within what distance of their median `_COMPARED` of some slip ratios are [-]."""
    return float(np.quantile(np.abs(values - np.median(values)), _COMPARED))


def _slip_from_speeds(table: RigTable, *, unused: MappedColumn | None) -> SlipColumn:
    """Compute the `material` slip ratio from the speeds of the surfaces.

    Raises `DataError` where the leg disc stands still. `unused` is a slip ratio in the table that
    is ignored, for the note.
    """
    leg, ground = (surface_speed(table, disc) for disc in DISCS)
    ratio = slip_ratio(leg, ground, SlipDefinition.MATERIAL)
    column = speed_column(table, "leg")
    header = table.required(column).name
    table.require(
        column,
        np.isfinite(ratio),
        lambda value: (
            f"the leg disc stands still ({value}), so that slip is undefined; skip such rows with "
            f'[rows] keep = ["`{header}` > 0.1"] in {table.columns.stated_in}'
        ),
    )
    surface = all(speed_column(table, disc) == f"speed_{disc}" for disc in DISCS)
    speeds = "surface speeds" if surface else "disc speeds and radii"
    origin = f"computed from {speeds}, definition material"
    if unused:
        origin += f"; '{unused.name}' is not used, because its definition is not stated"
    return SlipColumn(ratio, SlipDefinition.MATERIAL, column, origin)
