# SPDX-License-Identifier: MIT
"""Parse a slip curve that a calibration is compared with: a name, numbers, or a table."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.slip.definition import SlipDefinition, convert_slip, is_possible
from model.slip.load_curves import curves_by_load
from model.slip.magic_formula import magic_formula
from model.slip.read_off import initial_slope
from model.slip.thesis import thesis_curve
from zebro_lab.calibration.coulomb_argument import COULOMB, MOST_FRICTION, coulomb_numbers
from zebro_lab.calibration.curve_table import read_curve_table
from zebro_lab.calibration.slip_argument import THESIS
from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.columns import parse_definition
from zebro_lab.tables.table_files import is_table_file

MAGIC: Final = "magic"
EXPECTED_CURVE: Final = f"{THESIS}, {COULOMB}:MU, {MAGIC}:B,C,D,E or a table of a curve"
_EXPECTED_MAGIC = (
    f"{MAGIC}:B,C,D,E with D over load [-], such as {MAGIC}:34.34,1.564,0.3798,0, or "
    f"{MAGIC}:B,C,D,E@LOAD with D and LOAD in newtons; :travel, :material or :larger may follow"
)


@dataclass(frozen=True)
class GivenCurve:
    """A slip curve without uncertainty.

    Attributes:
        text: How it was named.
        own_force: Force of the curve [N] at slip ratios in its own definition (n,) and a load [N];
            NaN where it is unknown.
        own_slope: Slope at zero slip [N] at a load [N], infinite for a jump; NaN if it is unknown.
        definition: Its slip definition; None if the force is the same in all, or it was not stated.
        loads: Loads that it is for [N]; None if it is for any.
        stated: Whether the definition is known, or does not matter.
        source: Source of a table; "" of others, which state nothing about data.
        files: Files that were read.
        notes: Notes, one line each.
    """

    text: str
    own_force: Callable[[Array, float], Array]
    own_slope: Callable[[float], float]
    definition: SlipDefinition | None
    loads: tuple[float, ...] | None = None
    stated: bool = True
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
        """Return notes on the slip definition, beside that of the calibration."""
        if not self.stated:
            return (
                f"{self.text}: its slip ratio is taken as '{definition}', that of the calibration; "
                f"append :travel, :material or :larger if it is another",
            )
        if self.definition in (None, definition):
            return ()
        return (f"{self.text}: its '{self.definition}' slip is converted to '{definition}'",)


def is_curve(path: Path) -> bool:
    """Return whether an argument names a curve: by its form, or as a table file by its name."""
    text = str(path)
    named = text == THESIS or text.partition(":")[0] in (COULOMB, MAGIC)
    return named or (path.is_file() and is_table_file(path))


def parse_curve(path: Path) -> GivenCurve:
    """Parse the name of a curve, or read its table.

    Args:
        path: `thesis`, `coulomb:MU`, `magic:B,C,D,E[@LOAD][:DEFINITION]`, or a table of a curve.

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
    if text.partition(":")[0] == MAGIC:
        return _magic(text)
    return _table(path)


def _coulomb(text: str) -> GivenCurve:
    """Parse `coulomb:MU`: mu times load at any slip, in the direction of slip."""
    friction, *others = coulomb_numbers(text) or (math.nan,)
    if others:
        raise SettingsError(
            f"'{text}' sets in over a velocity, which a curve over slip ratio does not have; give "
            f"{COULOMB}:{friction:g}"
        )
    return GivenCurve(
        text, lambda slip, load: friction * load * np.sign(slip), lambda _: math.inf, None
    )


def _magic(text: str) -> GivenCurve:
    numbers, _, named = text.removeprefix(f"{MAGIC}:").partition(":")
    coefficients, at, load_text = numbers.partition("@")
    try:
        B, C, D, E = (float(part) for part in coefficients.split(","))
        load = float(load_text.removesuffix("N")) if at else None
    except ValueError as error:
        raise SettingsError(f"'{text}' is no curve; expected {_EXPECTED_MAGIC}") from error
    _require_formula(text, B, C, D, E, load)
    over_load = D if load is None else D / load
    definition = parse_definition(named, file=None, key=text) if named else None
    note = f"{text}: D is {D:g} times the load" if load is None else f"{text}: D is {D:g} N"
    return GivenCurve(
        text,
        lambda slip, at_load: magic_formula(slip, B, C, over_load * at_load, E),
        lambda at_load: B * C * over_load * at_load,
        definition,
        loads=None if load is None else (load,),
        stated=bool(named),
        notes=(note,),
    )


def _require_formula(text: str, B: float, C: float, D: float, E: float, load: float | None) -> None:
    """Raise `SettingsError` for coefficients that give no curve with one peak and sign."""
    if not all(map(math.isfinite, (B, C, D, E, load or 1.0))):
        raise SettingsError(f"'{text}' has a number that is not finite; {_EXPECTED_MAGIC}")
    if not (B > 0 and 0 < C <= 2 and D > 0 and E <= 1 and (load is None or load > 0)):
        raise SettingsError(
            f"'{text}': expected B above 0, C above 0 and at most 2, D above 0, E at most 1, and a "
            "load above 0"
        )
    if load is None and D > MOST_FRICTION:
        raise SettingsError(
            f"'{text}': D is {D:g} times the load, expected at most {MOST_FRICTION:g}; if it is in "
            f"newtons, name the load: {MAGIC}:{B:g},{C:g},{D:g},{E:g}@LOAD"
        )


def _table(path: Path) -> GivenCurve:
    """Read a table of a curve; between points the force is interpolated linearly."""
    table = read_curve_table(path)
    load = np.ones_like(table.slip) if table.load is None else table.load
    curves = curves_by_load(table.slip, load, table.traction)

    def nearest(at_load: float) -> int:
        return int(np.argmin([abs(math.log(each.load / at_load)) for each in curves]))

    def force(slip: Array, at_load: float) -> Array:
        if table.load is None:
            return curves[0].force_at(slip) * at_load
        return curves[nearest(at_load)].force_at(slip)

    def slope(at_load: float) -> float:
        curve = curves[0 if table.load is None else nearest(at_load)]
        try:
            found = initial_slope(curve.driving().slip, curve.driving().force)
        except DomainError:  # too few points on the rise: the slope is not known
            return math.nan
        return found * at_load if table.load is None else found

    return GivenCurve(
        str(path),
        force,
        slope,
        table.definition,
        loads=None if table.load is None else tuple(each.load for each in curves),
        source=table.source,
        files=table.files,
        notes=table.notes,
    )
