# SPDX-License-Identifier: MIT
"""Parse a slip curve that a calibration is compared with: a name, a friction, or a table."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.slip.definition import SlipDefinition, convert_slip, is_possible
from model.slip.load_curves import LoadCurve, curves_by_load
from model.slip.read_off import initial_slope
from model.slip.thesis_curve import thesis_curve
from zebro_lab.calibration.coulomb_argument import COULOMB, coulomb_numbers
from zebro_lab.calibration.slip_argument import THESIS
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.tables.columns_file import rig_columns
from zebro_lab.tables.rig_table import RigTable, normal_force, traction
from zebro_lab.tables.row_conditions import kept_rows
from zebro_lab.tables.slip_source import slip
from zebro_lab.tables.table_files import is_table_file, read_table_file

EXPECTED_CURVE: Final = f"{THESIS}, {COULOMB}:MU or a table of a curve"


@dataclass(frozen=True)
class GivenCurve:
    """A slip curve without uncertainty.

    Attributes:
        text: How it was named.
        own_force: Force of the curve [N] at slip ratios in its own definition (n,) and a load [N];
            NaN where it is unknown.
        own_slope: Slope at zero slip [N] at a load [N], infinite for a jump; NaN if it is unknown.
        definition: Its slip definition; None if the force is the same in all.
        loads: Loads that it is for [N]; None if it is for any.
        source: Source of a table; "" of others, which state nothing about data.
        files: Files that were read.
        notes: Notes, one line each.
    """

    text: str
    own_force: Callable[[Array, float], Array]
    own_slope: Callable[[float], float]
    definition: SlipDefinition | None
    loads: tuple[float, ...] | None = None
    source: str = ""
    files: tuple[Path, ...] = ()
    notes: tuple[str, ...] = ()

    def force(self, slip: Array, load: float, definition: SlipDefinition) -> Array:
        """Compute the force [N] at slip ratios in any definition, NaN where it is unknown.

        It is unknown too where the slip ratio has no finite counterpart in the curve's definition:
        at and beyond the limit of a leg that spins on the spot, where noise may put a measured one.

        Args:
            slip: Slip ratios, shape (n,) [-].
            load: Normal force [N].
            definition: Definition of `slip`.
        """
        own = slip
        if self.definition not in (None, definition):
            own = np.where(is_possible(slip, definition), slip, np.nan)
            own = convert_slip(own, definition, self.definition)
        known = np.isfinite(own)
        force = np.full(len(slip), np.nan)
        force[known] = self.own_force(own[known], load)
        return force

    def said(self, definition: SlipDefinition) -> tuple[str, ...]:
        """Return a note that slip is converted, if a calibration has another definition."""
        if self.definition in (None, definition):
            return ()
        return (f"{self.text}: its '{self.definition}' slip is converted to '{definition}'",)


def is_curve(path: Path) -> bool:
    """Return whether an argument names a curve: by its form, or as a table file by its name."""
    text = str(path)
    named = text == THESIS or text.partition(":")[0] == COULOMB
    return named or (path.is_file() and is_table_file(path))


def parse_curve(path: Path) -> GivenCurve:
    """Parse the name of a curve, or read its table.

    Args:
        path: `thesis`, `coulomb:MU`, or a table of a curve.

    Raises:
        SettingsError: Numbers are missing, too many or impossible.
        ZebroLabError: The table cannot be read, see `read_curve_table`.
    """
    text = str(path)
    if text == THESIS:
        curve = thesis_curve()
        return GivenCurve(
            text,
            lambda slip, load: curve.force(slip, load, definition=curve.definition),
            lambda load: float(curve.law.slip_derivative(0.0, load, curve.values)),
            curve.definition,
        )
    if text.partition(":")[0] == COULOMB:
        return _coulomb(text)
    return _table(path)


def _coulomb(text: str) -> GivenCurve:
    """Parse `coulomb:MU`: mu times load at any slip, in the direction of slip.

    Raises `SettingsError` if a velocity follows MU, or as `coulomb_numbers` does.
    """
    friction, *others = coulomb_numbers(text) or (math.nan,)
    if others:
        raise SettingsError(
            f"'{text}' sets in over a velocity, which a curve over slip ratio does not have; give "
            f"{COULOMB}:{friction:g}"
        )
    return GivenCurve(
        text, lambda slip, load: friction * load * np.sign(slip), lambda _: math.inf, None
    )


def _table(path: Path) -> GivenCurve:
    """Read a table of curves at one load or more as one curve.

    At any load it is the curve of the nearest load, by their ratio; between points the force is
    interpolated linearly. The slope is that of the driving side, NaN if it has too few points.
    """
    table = read_curve_table(path)
    curves = curves_by_load(table.slip, table.load, table.traction)

    def nearest(load: float) -> LoadCurve:
        return min(curves, key=lambda each: abs(math.log(each.load / load)))

    def slope(load: float) -> float:
        side = nearest(load).driving()
        try:
            return initial_slope(side.slip, side.force)
        except DomainError:  # too few points on the rise: the slope is not known
            return math.nan

    return GivenCurve(
        str(path),
        lambda slip, load: nearest(load).force_at(slip),
        slope,
        table.definition,
        loads=tuple(each.load for each in curves),
        source=table.source,
        files=table.files,
        notes=table.notes,
    )


_FEWEST = 3


@dataclass(frozen=True)
class CurveTable:
    """Points of slip curves as a table gives them.

    Attributes:
        slip: Slip ratio of each point, shape (n,) [-].
        load: Normal force of each point, shape (n,) [N].
        traction: Traction force of each point, shape (n,) [N].
        definition: Slip definition.
        source: Source as stated; "unknown" if not stated.
        files: Files that were read.
        notes: How the file was read and which units were converted, one line each.
    """

    slip: Array
    load: Array
    traction: Array
    definition: SlipDefinition
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...]


def is_curve_table(path: Path) -> bool:
    """Return whether a file is a table whose rows are points of a curve, not samples of runs.

    Neither its headers nor the columns of its `columns.toml` include a time, run or disc speed, and
    [runs] of that file states neither `by` nor `gap`. False if there is no such file.
    """
    if not path.is_file():
        return False
    columns = rig_columns(path)
    raw = read_table_file(path, sheet=columns.sheet)
    samples = {"t", "run", "omega_leg", "omega_ground", "speed_leg", "speed_ground"}
    has_runs = bool(columns.runs.by) or columns.runs.gap is not None
    return not (has_runs or samples & {*raw.columns, *columns.columns})


def read_curve_table(path: Path, *, columns: Path | None = None) -> CurveTable:
    """Read a table whose rows are points of slip curves.

    Args:
        path: The table; its columns are canonical, or mapped by the nearest `columns.toml`.
        columns: A `columns.toml` to use instead.

    Raises:
        ZebroLabError: The table or its column map cannot be read, a column or the slip definition
            is missing, a value is not finite or impossible, or there are fewer than 3 points.
    """
    entries = rig_columns(path, columns)
    raw = read_table_file(path, sheet=entries.sheet)
    table = RigTable(raw, entries, kept_rows(raw, entries.keep))
    if len(table.rows) < _FEWEST:
        raise DataError(f"has {len(table.rows)} points; a curve needs {_FEWEST} or more", file=path)
    ratio, load = slip(table), normal_force(table)
    sources = [each for each in (entries.source, raw.source) if each]
    return CurveTable(
        slip=ratio.ratio,
        load=load,
        traction=traction(table, load)[0],
        definition=ratio.definition,
        source=sources[0] if sources else "unknown",
        files=(path,) if entries.file is None else (path, entries.file),
        notes=(*raw.notes, *table.conversions()),
    )
