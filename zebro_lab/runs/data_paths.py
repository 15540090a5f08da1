# SPDX-License-Identifier: MIT
"""Find the table files and run folders named on a command line."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.folder_manifest import result_kind
from zebro_lab.runs.folder import LOG_FILE
from zebro_lab.runs.manifest import MANIFEST_FILE
from zebro_lab.tables.columns import COLUMNS_FILE, RIG
from zebro_lab.tables.columns_file import read_columns, rig_columns
from zebro_lab.tables.columns_sections import columns_above
from zebro_lab.tables.rig_columns import RigColumns
from zebro_lab.tables.table_files import PLAIN_SUFFIXES, is_table_file

CALIBRATION_FILE = "slip.toml"  # a folder with this file is a calibration folder, not data


@dataclass(frozen=True)
class DataSource:
    """One table file or one run folder.

    Attributes:
        path: The table file or the run folder.
        root: The folder named on the command line, or the parent of the named file; there the
            upward search for the `columns.toml` of a run folder ends.
    """

    path: Path
    root: Path

    @property
    def is_run_folder(self) -> bool:
        """Whether the path is a run folder, not a table file."""
        return self.path.is_dir()

    def columns(self) -> RigColumns:
        """Read the nearest `columns.toml`; of a run folder, up to the root only.

        Raises:
            SettingsError: It cannot be read, or has an invalid value.
        """
        if self.is_run_folder:
            file = self._columns_of_run()
            return RigColumns() if file is None else read_columns(file)
        return rig_columns(self.path)

    def _columns_of_run(self) -> Path | None:
        """Return the nearest `columns.toml` from the run folder up to the root; None if none is."""
        folder = self.path
        while True:
            if (folder / COLUMNS_FILE).is_file():
                return folder / COLUMNS_FILE
            if folder in (self.root, folder.parent):
                return None
            folder = folder.parent


def columns_above_roots(sources: Sequence[DataSource], named: Path | None) -> tuple[str, ...]:
    """Return notes on tables whose columns or source are stated above the folder that was named.

    Args:
        sources: The data; the same of several tables of one folder is said once.
        named: The `columns.toml` that is named; None if none is.
    """
    # reversed twice: the first of each folder is kept, in the order of `sources`
    first = {source.path.parent: source for source in reversed(sources) if source.path.is_file()}
    return tuple(
        line
        for source in reversed(first.values())
        for line in columns_above(RIG, source.path, named, root=source.root)
    )


def find_sources(paths: Sequence[Path]) -> list[DataSource]:
    """Find table files and run folders recursively; a path reached twice is listed once.

    A folder that is no run folder stands for every table and every run folder below
    it, sorted by name. Links are followed; hidden files and folders, results of commands, such as
    calibration folders, and all that is inside run folders, are skipped.

    Args:
        paths: Files and folders, as named; `run.json` and `log.mcap` stand for their folder, any
            other file is taken for a table.

    Raises:
        NotFound: A path does not exist, or `paths` is empty.
        DataError: A named folder holds no data.
    """
    if not paths:
        raise NotFound("no data given; give tables, run folders, or folders of them")
    found: dict[Path, DataSource] = {}
    for path in map(Path, paths):
        for source in _sources_at(path):
            found.setdefault(source.path.resolve(), source)
    return list(found.values())


def _sources_at(path: Path) -> list[DataSource]:
    """Return the data at one path: all below a folder, the folder of a run's file, or a table.

    Raises:
        NotFound: The path does not exist.
        DataError: It is a folder without data.
    """
    if not path.exists():
        raise NotFound(f"{path}: no such file or folder; the working folder is {Path.cwd()}")
    if path.is_dir():
        sources = [DataSource(below, path) for below in _walk(path, set())]
        if not sources:
            raise DataError(_why_empty(path), file=path)
        return sources
    if path.name in (MANIFEST_FILE, LOG_FILE):
        return _sources_at(path.parent)
    return [DataSource(path, path.parent)]


def _walk(folder: Path, entered: set[tuple[int, int]]) -> Iterator[Path]:
    """Yield a run folder itself, or the tables and run folders below another folder, by name.

    A result of a command, such as a calibration, yields nothing; hidden files and folders below
    are skipped.

    Args:
        folder: Folder to search; one already visited, as by cyclic links, yields nothing.
        entered: Device and inode of the folders already visited; those of `folder` are added.
    """
    status = folder.stat()
    if (status.st_dev, status.st_ino) in entered:
        return
    entered.add((status.st_dev, status.st_ino))
    if (folder / MANIFEST_FILE).is_file():
        yield folder
        return
    if (folder / CALIBRATION_FILE).is_file() or result_kind(folder) is not None:
        return
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        if path.is_dir():
            yield from _walk(path, entered)
        elif is_table_file(path):
            yield path


def _why_empty(folder: Path) -> str:
    """Return why a folder holds no data: it is a result of a command, or has no tables and runs."""
    if (folder / CALIBRATION_FILE).is_file():
        return "is the result of a calibration; give the data that the calibration was made from"
    if (kind := result_kind(folder)) is not None:
        return f"is the result of a command (kind '{kind}'), not data; give tables or run folders"
    return (
        f"holds no data; expected files ending in {', '.join(PLAIN_SUFFIXES)} or run folders with "
        f"a {MANIFEST_FILE}, in this folder or folders in it"
    )
