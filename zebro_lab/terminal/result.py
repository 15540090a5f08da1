# SPDX-License-Identifier: MIT
"""Print the results of a command: what is simulated, tables and notes, and the folder written."""

from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.table import Table

from zebro_lab.files.source_names import is_simulated
from zebro_lab.terminal.tables import plain

WARNING = "WARNING"
"""First word of a note that says why a result may be wrong."""


def print_result(
    console: Console,
    parts: Iterable[str | Table],
    *,
    source: str = "",
    out: Path,
    files: Iterable[Path] = (),
) -> None:
    """Print tables and lines in their order, first that data are simulated, last the folder.

    Args:
        console: Console to print to.
        parts: Tables, and lines of text, shown as they are.
        source: Source of the data, by which they are simulated or not.
        out: Folder that was written.
        files: Files in it to list; none for its name alone.
    """
    if is_simulated(source):
        console.print(plain(f"SIMULATED: {source}"))
    for part in parts:
        console.print(plain(part) if isinstance(part, str) else part)
    files = list(files)
    console.print()
    console.print(plain(f"written to {out}" + ":" * bool(files)))
    for file in files:
        console.print(plain(f"  {file}"))


def warnings_first(notes: Iterable[str]) -> tuple[list[str], list[str]]:
    """Return the notes that are warnings, and the others, in their order."""
    notes = list(notes)
    warnings = [note for note in notes if note.startswith(WARNING)]
    return warnings, [note for note in notes if note not in warnings]
