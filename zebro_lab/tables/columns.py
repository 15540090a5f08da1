# SPDX-License-Identifier: MIT
"""Columns of a table as canonical columns in SI: what a `columns.toml` states, as values."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType

from model.arrays import Array
from model.similar_name import nearest
from model.slip.definition import SlipDefinition
from model.slip.rig_errors import (
    RADIUS_TOLERANCE,
    ROLLING_RESISTANCE,
    RUN_OUT,
    UNKNOWN_RATIO,
    UNKNOWN_SCATTER,
    RigErrors,
    radius_ratio_sd,
    run_out_scatter,
)
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.units import counts_turns, factor_to_si, is_unit_text, may_be_gradian
from zebro_lab.tables.date_cells import is_date_unit, seconds_of_dates
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.row_conditions import RowCondition

COLUMNS_FILE = "columns.toml"


@dataclass(frozen=True)
class CanonicalColumn:
    """A column that a calibration uses.

    Attributes:
        name: Canonical name of the column.
        unit: SI unit of the column; None if its cells are text.
        meaning: Description in one line, with the sign convention.
    """

    name: str
    unit: str | None
    meaning: str


CANONICAL: Mapping[str, CanonicalColumn] = MappingProxyType({
    column.name: column
    for column in (
        CanonicalColumn("t", "s", "time, increasing within a run"),
        CanonicalColumn("omega_leg", "rad/s", "angular speed of the leg disc"),
        CanonicalColumn("omega_ground", "rad/s", "angular speed of the ground disc"),
        CanonicalColumn("angle_leg", "rad", "angle of the leg disc, of one zero; for its run-out"),
        CanonicalColumn("angle_ground", "rad", "angle of the ground disc, of one zero"),
        CanonicalColumn("radius_leg", "m", "radius of the leg disc at the contact"),
        CanonicalColumn("radius_ground", "m", "radius of the ground disc at the contact"),
        CanonicalColumn("slip_ratio", "dimensionless", "slip ratio, with its definition"),
        CanonicalColumn("normal_force", "N", "normal force, positive when pressed together"),
        CanonicalColumn("traction_force", "N", "traction force, positive when driving"),
        CanonicalColumn("lateral_force", "N", "force across the discs, if the cell measures it"),
        CanonicalColumn("run", None, "name or number of the run"),
        CanonicalColumn("slip_definition", None, "material, travel or larger; one in each file"),
    )
})  # fmt: skip


@dataclass(frozen=True)
class MappedColumn:
    """The column of a file that a canonical column is read from.

    Attributes:
        name: Header of the column in the file, which may lack it.
        unit: Unit of the column in the file; "" for text.
        factor: Multiplies the file's numbers to give SI with the canonical sign.
        definition: Slip definition, for `slip_ratio` only; None if not stated.
        unit_stated: Whether the column map states the unit; else that of the file holds, if any.
        offset: Added to the numbers in SI: where zero is elsewhere than the canonical column's.
        nanoseconds: Header of a column of nanoseconds to add to a time; None without one.
        scale: Multiplies the file's numbers to give numbers in the unit; contained in `factor`.
    """

    name: str
    unit: str = ""
    factor: float = 1.0
    definition: SlipDefinition | None = None
    unit_stated: bool = False
    offset: float = 0.0
    nanoseconds: str | None = None
    scale: float = 1.0

    @property
    def said(self) -> str:
        """The header with the unit that its numbers are in: `'FT_mN' in mN times 0.001`."""
        scale = f"{self.scale:g} " if self.scale != 1 else ""
        turns = ", revolutions per minute," if counts_turns(self.unit, "rad/s") else ""
        factor = f" times {self.factor:g}" if self.factor != 1 else ""
        return f"'{self.name}' in {scale}{self.unit}{turns}{factor}"

    def in_si(self, table: RawTable) -> Array:
        """Return the column's numbers in SI with the canonical sign, shape (n,); NaN where empty.

        The unit that the file states is taken into account by `in_unit_of`.

        Args:
            table: The table that the column is read from.

        Raises:
            DataError: The column is missing or ambiguous, or a cell is not a number (a date, if the
                unit says so).
        """
        if is_date_unit(self.unit):
            values = self.factor * seconds_of_dates(table, self.name, self.unit)
        else:
            values = table.numbers(self.name) * self.factor
        if self.nanoseconds is not None:
            values = values + 1e-9 * table.numbers(self.nanoseconds)
        return values + self.offset if self.offset else values

    def in_unit_of(self, table: RawTable, si_unit: str | None) -> "MappedColumn":
        """Return the column with the unit that the file states for it, unless the map states one.

        Args:
            table: The table that the column is read from.
            si_unit: SI unit of the canonical column; None if its cells are text.

        Raises:
            DataError: The unit of the file is unknown or measures another quantity.
        """
        if self.unit_stated or si_unit is None:
            return self
        unit = table.unit_of(self.name, si_unit)
        if unit is None:
            return self
        advice = f'state unit = "{si_unit}" or what it is in {COLUMNS_FILE}, {scaled(si_unit)}'
        if unit == unit_in_header(self.name) and not is_unit_text(unit):
            problem = f"'{unit}' in the header is no unit that is known; {advice}"
            raise table.fault(problem, self.name)
        if may_be_gradian(unit):
            problem = f"the file states 'grad', which may be degrees or gradians; {advice}"
            raise table.fault(problem, self.name)
        try:
            factor = factor_to_si(unit, si_unit)
        except UnitError as error:
            problem = f"the file states its unit: {error}; {advice}"
            raise table.fault(problem, self.name) from error
        return replace(self, unit=unit, factor=math.copysign(factor, self.factor))


def scaled(si_unit: str) -> str:
    """Return how to state a unit that is not known, as a multiple of the SI unit, for messages."""
    unit = "" if si_unit == "dimensionless" else f" {si_unit}"
    return f'or scale = NUMBER, unit = "{si_unit}" if 1 in the file is NUMBER{unit}'


@dataclass(frozen=True)
class RunRule:
    """Rule that separates the rows of one file into runs; at most one attribute is given.

    Without a rule, a change in the `run` column starts a run; without that, the file is one run.

    Attributes:
        by: Columns, by their headers in the file; a change of value in one starts a new run.
        gap: Interval between samples beyond which a new run starts [s]; None if not given.
        each_row: Whether every row is the mean of one trial, and therefore a run.
    """

    by: tuple[str, ...] = ()
    gap: float | None = None
    each_row: bool = False


@dataclass(frozen=True)
class RigErrorsStated:
    """Standard deviations of errors of the rig, as a `columns.toml` states them.

    Attributes:
        radius: Of each disc's radius [m].
        radius_ratio: Of the relative error of the ratio of the radii, instead of `radius` [-]; None
            if not given.
        rolling_resistance: Of the rolling resistance over the load [-].
        run_out: Amplitude by which each disc's radius at the contact varies once a turn, and the
            standard deviation of each coefficient of a disc whose angle is recorded [m].
    """

    radius: float = RADIUS_TOLERANCE
    radius_ratio: float | None = None
    rolling_resistance: float = ROLLING_RESISTANCE
    run_out: float = RUN_OUT

    def resolved(self, radii: Mapping[str, float]) -> RigErrors:
        """Return the standard deviations that a fit takes.

        Args:
            radii: `radius_leg` and `radius_ground` [m], those that are known; without both, the
                ratio's standard deviation is `UNKNOWN_RATIO` if it is not given, and the scale of
                slip that the speeds do not show `UNKNOWN_SCATTER`.
        """
        ratio, scatter = UNKNOWN_RATIO, UNKNOWN_SCATTER
        if {"radius_leg", "radius_ground"} <= radii.keys():
            both = radii["radius_leg"], radii["radius_ground"]
            ratio = radius_ratio_sd(*both, self.radius)
            scatter = run_out_scatter(*both, self.run_out)
        ratio = ratio if self.radius_ratio is None else self.radius_ratio
        return RigErrors(ratio, self.rolling_resistance, scatter, self.run_out)


@dataclass(frozen=True)
class Columns:
    """Content of a `columns.toml`.

    Attributes:
        file: The `columns.toml` itself; None without one: headers are canonical names, in SI.
        source: "real", "sim:what", "replay:what" or "unknown"; None if not stated.
        sheet: Sheet of a workbook to read; None for the only one.
        columns: Mapped columns by canonical name; only those with an entry.
        constants: Given radii of the discs, `radius_leg` and `radius_ground` [m], by name.
        runs: Rule that separates rows into runs.
        keep: Conditions that every kept row must meet, all of them.
        load_cell: Given standard deviations from the load cell's certificate by name, SI:
            `zero_stability`, `gain_sd`, `bias_sd`, `crosstalk_sd`.
        priors: What is known of parameters beforehand, as texts such as "friction = 0.4 ± 0.05".
        rig_errors: Standard deviations of errors of the rig.
    """

    file: Path | None = None
    source: str | None = None
    sheet: str | None = None
    columns: Mapping[str, MappedColumn] = field(default_factory=dict)
    constants: Mapping[str, float] = field(default_factory=dict)
    runs: RunRule = RunRule()
    keep: tuple[RowCondition, ...] = ()
    load_cell: Mapping[str, float] = field(default_factory=dict)
    priors: tuple[str, ...] = ()
    rig_errors: RigErrorsStated = field(default_factory=lambda: RigErrorsStated())

    @property
    def stated_in(self) -> str:
        """The `columns.toml` by its path, for messages; by its name alone where there is none."""
        return str(self.file or COLUMNS_FILE)


def parse_definition(text: object, *, file: Path | None, key: str) -> SlipDefinition:
    """Parse the name of a slip definition.

    Args:
        text: Name of the definition: material, travel or larger.
        file: File that it was read from, for the error message.
        key: Key or column that it was read from, for the error message.

    Raises:
        SettingsError: There is no definition of this name.
    """
    try:
        return SlipDefinition(str(text))
    except ValueError as error:
        advice = nearest(str(text), list(SlipDefinition))
        raise SettingsError(
            f"unknown slip definition '{text}'; {advice}", file=file, key=key
        ) from error
