# SPDX-License-Identifier: MIT
"""Write a commented `columns.toml` for a table, guessed from its header, units and numbers."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from zebro_lab.exchange.column_guesses import ColumnGuess, guess_columns, guess_kind
from zebro_lab.exchange.columns_template import render_columns
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.files.opening import read_text
from zebro_lab.ground.ground_file import TEMPLATE
from zebro_lab.robot.robot_file import RobotFile, render_robot_file
from zebro_lab.tables.columns import COLUMNS_FILE, RIG
from zebro_lab.tables.columns_sections import DOUBT, is_sectioned
from zebro_lab.tables.table_files import read_table_file

Kind = Literal["rig", "legs", "imu", "track"]


@dataclass(frozen=True)
class WrittenColumns:
    """A written column map.

    Attributes:
        file: The `columns.toml`.
        kind: Kind of the table.
        guesses: Guessed columns by canonical name.
        doubts: Number of values that end in "?".
        notes: Notes on how the table was read, one line each.
    """

    file: Path
    kind: str
    guesses: Mapping[str, ColumnGuess]
    doubts: int
    notes: tuple[str, ...] = ()


def write_columns_template(
    file: Path, *, kind: Kind | None = None, sheet: str | None = None, force: bool = False
) -> WrittenColumns:
    """Write a commented `columns.toml` beside a table, guessed from its header and numbers.

    What is not sure is marked by a final "?", which every command refuses. A table of another kind
    than those that an existing `columns.toml` has sections for gets a section of its own in it.

    Args:
        file: The table.
        kind: Kind of the table; None to tell it from the headers.
        sheet: Sheet of a workbook; None for the only one.
        force: Whether to replace an existing `columns.toml`.

    Returns:
        The written file, and what was guessed.

    Raises:
        NotFound: The table file does not exist.
        DataError: The table, or the existing `columns.toml`, cannot be read.
        SettingsError: The headers leave the kind open, or the existing file is no TOML.
        AlreadyExists: A `columns.toml` beside the table maps tables of this kind, and `force` is
            not set.
        OSError: The file cannot be written.
    """
    file = Path(file)
    target = file.parent / COLUMNS_FILE
    present = "" if force or not target.exists() else read_text(target)
    table = read_table_file(file, sheet=sheet)
    found = kind or guess_kind(table)
    _require_free(target, present, found)
    guesses = guess_columns(table, found)
    text = render_columns(
        table, found, guesses,
        sheet=sheet, sectioned=found != RIG or bool(present), appended=bool(present),
    )  # fmt: skip
    atomic_write_text(target, f"{present.rstrip()}\n\n{text}" if present else text)
    values = [line.partition("  # ")[0] for line in text.splitlines() if line[:1] != "#"]
    doubts = sum(value.count(f'{DOUBT}"') for value in values)
    return WrittenColumns(target, found, guesses, doubts, table.notes)


def _require_free(target: Path, present: str, kind: str) -> None:
    """Raise if an existing `columns.toml` has no place for a section of a kind.

    It has none if it is without sections, or has one of this kind.

    Args:
        target: The file.
        present: Its text; "" where there is none, or where it is replaced.
        kind: Kind of the table.

    Raises:
        AlreadyExists: There is no place.
        SettingsError: The file is no TOML.
    """
    if not present:
        return
    document = read_toml_document(target, advice=f"expected a {COLUMNS_FILE}")
    advice = "edit that file, or replace it with --force"
    if not is_sectioned(document):
        raise AlreadyExists(
            f"{target} exists already, without sections, for one kind of table; {advice}; for a "
            f"table of another kind move its keys into sections, such as [{RIG}.columns], or use "
            "another folder"
        )
    if kind in document:
        raise AlreadyExists(f"{target} exists already; {advice}")


def write_template(file: Path, kind: Literal["ground", "robot"], *, force: bool = False) -> Path:
    """Write a commented `ground.toml` of level ground, or `robot.toml` of the thesis's robot.

    Args:
        file: File to write.
        kind: What to write.
        force: Whether to replace an existing file.

    Returns:
        The path of the file.

    Raises:
        AlreadyExists: The file exists, and `force` is not set; or it is a folder.
        OSError: The file cannot be written.
    """
    if file.is_dir():
        raise AlreadyExists(f"{file} is a folder; name the file to write, such as {kind}.toml")
    if file.exists() and not force:
        raise AlreadyExists(
            f"{file} exists already; edit it, replace it with --force, or choose another file name"
        )
    ground = TEMPLATE.format(name=file.name)
    return atomic_write_text(file, ground if kind == "ground" else render_robot_file(RobotFile()))
