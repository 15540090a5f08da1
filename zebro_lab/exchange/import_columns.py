# SPDX-License-Identifier: MIT
"""Find and parse the column map (`columns.toml`) that applies to each imported file."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.robot.imu_log import IMU_UNITS
from zebro_lab.robot.leg_log import LEG_UNITS
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.columns_file import parse_columns
from zebro_lab.tables.columns_sections import read_nearest, read_section
from zebro_lab.tables.mapped_columns import MappedColumns, canonical_columns, parse_mapped_columns
from zebro_lab.tables.table_kinds import IMU, LEGS, TRACK
from zebro_lab.track.trajectory.table import MAPPED_UNITS

SERIES: Final[Mapping[str, Mapping[str, str]]] = {
    LEGS: LEG_UNITS, IMU: IMU_UNITS, TRACK: MAPPED_UNITS,
}  # fmt: skip
"""SI unit of each column: by kind of time series, then by the column's canonical name."""


@dataclass(frozen=True)
class ForeignColumns:
    """Entries of a `columns.toml` for one imported file.

    Attributes:
        table: The entries, not parsed yet; None without a `columns.toml`.
    """

    table: SettingsTable | None = None

    @property
    def topic(self) -> str | None:
        """Topic of joint states to read from an MCAP log; None if not stated.

        Raises:
            SettingsError: The topic is not a string.
        """
        if self.table is None or "topic" not in self.table:
            return None
        return self.table.text("topic")

    def series(self, what: str) -> MappedColumns:
        """Parse the column map of a time series; without entries, the canonical names and units.

        Args:
            what: Kind of time series, a key of `SERIES`; the entry `topic` is ignored.

        Raises:
            SettingsError: A key, a unit or a sign is invalid.
        """
        if self.table is None:
            return replace(canonical_columns(SERIES[what]), where=f"{what}.")
        if "topic" in self.table:
            self.table.value("topic")
        return parse_mapped_columns(self.table, SERIES[what], with_rows=what == TRACK)

    def rig(self) -> Columns:
        """Parse the column map of a rig table; without entries, the default `Columns()`.

        Raises:
            SettingsError: A key, a unit or a value is invalid.
        """
        return Columns() if self.table is None else parse_columns(self.table)


def foreign_columns(
    what: str, table: Path, named: Path | None, *, alone: bool = False
) -> ForeignColumns:
    """Read the `columns.toml` for an imported file: the section of its kind.

    Without any section, all entries apply to leg and rig files, and only `source` to the others.

    Args:
        what: Kind of file: `legs`, `imu`, `track` or `rig`.
        table: Path of the imported file.
        named: A `columns.toml`; None for the nearest, from the file's folder upwards, if any.
        alone: Whether this is the only file that is imported: all entries of a named
            `columns.toml` without sections are for it.

    Raises:
        NotFound: The named `columns.toml` does not exist.
        SettingsError: The `columns.toml` cannot be read as TOML, has unknown keys beside its
            sections, a section is no table, or it has guesses that nobody has checked.
    """
    if named is None:
        return ForeignColumns(read_nearest(what, table.parent))
    return ForeignColumns(read_section(what, named, alone=alone))
