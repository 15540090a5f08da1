# SPDX-License-Identifier: MIT
"""The column map (`columns.toml`) of a trajectory in a table."""

from pathlib import Path

from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.columns import COLUMNS_FILE
from zebro_lab.tables.columns_file import nearest_columns, require_checked
from zebro_lab.tables.mapped_columns import MappedColumns, parse_mapped_columns
from zebro_lab.tables.table_kinds import TRACK
from zebro_lab.track.trajectory.table import MAPPED_UNITS


def trajectory_columns(file: Path, named: Path | None) -> MappedColumns | None:
    """Read the column map of a trajectory; None if there is none.

    It is the section `[track]` of the file that is named, or of the nearest `columns.toml`, from
    the trajectory's folder upwards; a named file without this section is taken as a whole.

    Args:
        file: The trajectory.
        named: A `columns.toml`; None for the nearest.

    Raises:
        NotFound: The named file does not exist.
        SettingsError: It cannot be read as TOML, a key, a unit or a sign is invalid, or a value is
            a guess that nobody has checked.
    """
    chosen = named or nearest_columns(TRACK, file.parent)
    if chosen is None:
        return None
    document = read_toml_document(chosen, advice=f"expected a {COLUMNS_FILE}")
    source = {"source": document["source"]} if "source" in document else {}
    if TRACK not in document:
        return None if named is None else _parsed(document, chosen, "")
    entries = document[TRACK]
    if not isinstance(entries, dict):
        raise SettingsError(f"found {entries!r}; expected a section", file=chosen, key=TRACK)
    return _parsed(source | entries, chosen, TRACK)


def _parsed(entries: dict[str, object], file: Path, section: str) -> MappedColumns:
    require_checked(entries, file=file, path=section)
    return parse_mapped_columns(
        SettingsTable(entries, file=file, path=section), MAPPED_UNITS, with_rows=True
    )
