# SPDX-License-Identifier: MIT
"""The column map (`columns.toml`) of a trajectory in a table."""

from pathlib import Path

from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.columns import COLUMNS_FILE
from zebro_lab.tables.columns_file import read_nearest, read_section, require_checked
from zebro_lab.tables.mapped_columns import MappedColumns, parse_mapped_columns
from zebro_lab.tables.table_kinds import TRACK
from zebro_lab.track.trajectory.table import MAPPED_UNITS


def trajectory_columns(file: Path, named: Path | None) -> MappedColumns | None:
    """Read the column map of a trajectory; None if nothing is stated.

    It is the section `[track]` of the file that is named, or of the nearest `columns.toml`, from
    the trajectory's folder upwards, with the nearest source that is stated; a named file without
    this section is taken as a whole.

    Args:
        file: The trajectory.
        named: A `columns.toml`; None for the nearest.

    Raises:
        NotFound: The named file does not exist.
        SettingsError: It cannot be read as TOML, a key, a unit or a sign is invalid, or a value is
            a guess that nobody has checked.
    """
    if named is None:
        entries = read_nearest(TRACK, file.parent)
    else:
        document = read_toml_document(named, advice=f"expected a {COLUMNS_FILE}")
        entries = read_section(TRACK, named) if TRACK in document else _whole(document, named)
    if entries is None or entries.empty:
        return None
    return parse_mapped_columns(entries, MAPPED_UNITS, with_rows=True)


def _whole(document: dict[str, object], file: Path) -> SettingsTable:
    require_checked(document, file=file)
    return SettingsTable(document, file=file)
