# SPDX-License-Identifier: MIT
"""Find the entries of a `columns.toml` for a kind of table: in its section, in the nearest file."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from model.similar_name import nearest
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.folder_manifest import result_kind
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.tables.columns import COLUMNS_FILE, KINDS, LEGS, RIG

DOUBT: Final = "?"
"""End of a value that was guessed and that nobody has checked."""
_GUESSED: Final = ("columns", "constants", "runs")
_SOURCES = ("real", "sim", "replay", "import", "mixed", "unknown")
"""Kinds of source; `import` and `mixed` only stand beside exported tables."""
PLAIN: Final = (LEGS, RIG)
"""Kinds whose `columns.toml` may be without sections."""


def read_nearest(kind: str, folder: Path) -> SettingsTable | None:
    """Read the entries for a kind of table of the nearest `columns.toml`; None without one.

    The source is that of the nearest one that states a source, which may be another file.

    Args:
        kind: One of `KINDS`.
        folder: Folder of the table.

    Raises:
        SettingsError: As `read_section` and `nearest_columns`.
    """
    file, stated = nearest_columns(kind, folder)
    if file is None:
        return None
    return read_section(kind, file, source=None if stated is None else stated[1])


def read_section(
    kind: str, file: Path, *, alone: bool = False, source: str | None = None
) -> SettingsTable:
    """Read the entries of a `columns.toml` that are for one kind of table.

    Without any section, all entries apply to leg and rig tables, and only `source` to the others.

    Args:
        kind: One of `KINDS`.
        file: The `columns.toml`.
        alone: Whether all entries of a file without sections are for this kind.
        source: Source that holds instead of that of the file; None for the file's.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file cannot be read as TOML, has unknown keys beside its sections, a
            section is no table, or an entry of this kind is a guess that nobody has checked.
    """
    document = read_toml_document(file, advice="expected a columns.toml")
    entries, path = document, ""
    if is_sectioned(document):
        for key in document:
            if key not in (known := ("source", *KINDS)):
                raise SettingsError(f"unknown key; {nearest(key, known)}", file=file, key=key)
        entries, path = document.get(kind, {}), kind
    elif kind not in PLAIN and not alone:
        entries = {}
    if not isinstance(entries, dict):
        raise SettingsError(f"found {entries!r}; expected a section [{kind}]", file=file, key=kind)
    require_checked(entries, file=file, path=path)
    common = {"source": document["source"]} if "source" in document else {}
    nearest_one = {} if source is None else {"source": source}
    return SettingsTable(common | entries | nearest_one, file=file, path=path)


def nearest_columns(kind: str, folder: Path) -> tuple[Path | None, tuple[Path, str] | None]:
    """Find the `columns.toml` for a kind of table: in its folder, or in the nearest one above.

    Files that have nothing for this kind are passed over; if there are no others, the nearest of
    them whose source would hold for the kind (`_gives_source`) is taken. One without sections above
    the table's folder is for legs if it maps their angles, else for rigs. Results of commands have
    their own headers: for them nothing above is looked up.

    Args:
        kind: One of `KINDS`.
        folder: Folder of the table.

    Returns:
        The file, None if there is none; and the nearest file that states a source for the kind,
        which may be another one, with that source, None if none does.

    Raises:
        SettingsError: A `columns.toml` on the way cannot be read as TOML.
    """
    mapping = other = stated = None
    for file, document, beside in _documents(folder):
        is_mapping = is_for(kind, document, beside=beside)
        if is_mapping or _gives_source(kind, document):
            stated = stated or _stated_source(kind, file, document)
            other = other or file
        if is_mapping:
            mapping = mapping or file
        if mapping and stated:
            break
    return mapping or other, stated


def columns_above(
    kind: str, table: Path, named: Path | None, *, root: Path | None = None
) -> tuple[str, ...]:
    """Return notes if columns or source of a table are stated above its folder.

    Args:
        kind: One of `KINDS`.
        table: Path of the table.
        named: The `columns.toml` that is named; None if none is.
        root: Folder named on the command line, in which nothing is noted; None for the table's.

    Raises:
        SettingsError: A `columns.toml` cannot be read as TOML, or the source is no text.
    """
    if named is not None:
        return ()
    root = table.parent if root is None else root
    mapping, stated = nearest_columns(kind, table.parent)
    notes = []
    if mapping and not mapping.is_relative_to(root) and _has_entries(kind, mapping):
        notes += [f"{table.name}: columns are those of {mapping}, the nearest for {kind} above it"]
    if stated and not stated[0].is_relative_to(root):
        notes += [f"{table.name}: its source, {stated[1]}, is stated in {stated[0]}, above it"]
    return tuple(notes)


def _has_entries(kind: str, file: Path) -> bool:
    """Return whether a `columns.toml` states more than the source of a kind of table."""
    return bool(set(read_section(kind, file).unread) - {"source"})


def _stated_source(kind: str, file: Path, document: Mapping[str, Any]) -> tuple[Path, str] | None:
    """Return a `columns.toml` and the source that it states for a kind of table; None if none."""
    for entries, path in ((document.get(kind), kind), (document, "")):
        if isinstance(entries, dict) and "source" in entries:
            table = SettingsTable(entries, file=file, path=path)
            return file, (read_source(table) or "") if kind == RIG else table.text("source")
    return None


def _documents(folder: Path) -> Iterator[tuple[Path, dict[str, Any], bool]]:
    """Yield each `columns.toml` in a folder or above it, its content, and whether it is in it."""
    for each in (folder, *_above(folder)):
        if (file := each / COLUMNS_FILE).is_file():
            advice = f"expected a {COLUMNS_FILE}"
            yield file, read_toml_document(file, advice=advice), each == folder


def _above(folder: Path) -> Iterator[Path]:
    """Yield the folders above one, the nearest first; none above the result of a command.

    Their paths are relative to the working folder where the folder is named so and lies in it.
    """
    if result_kind(folder) is not None:
        return
    working = Path.cwd()
    for each in folder.resolve().parents:
        is_within = each.is_relative_to(working) and not folder.is_absolute()
        yield each.relative_to(working) if is_within else each


def require_checked(entries: Mapping[str, Any], *, file: Path, path: str = "") -> None:
    """Check that no text ends in "?", as guesses of `zebro-lab init` do.

    Only the tables in `_GUESSED` are searched, with all tables and lists in them.

    Args:
        entries: Entries of a `columns.toml` or of a section of it.
        file: The file, for the message.
        path: Dotted name of the section; "" for the whole file.

    Raises:
        SettingsError: A value was guessed and is not checked; names all of them.
    """
    open_ = [
        f'{key} = "{value}"'
        for part in _GUESSED
        for key, value in _texts(entries.get(part), f"{path}.{part}".lstrip("."))
        if value.endswith(DOUBT)
    ]
    if open_:
        many = f"{len(open_)} values are guesses" if len(open_) > 1 else "a value is a guess"
        raise SettingsError(
            f"{many} that nobody has checked: {', '.join(open_)}; correct each where it is wrong "
            'and delete its "?"',
            file=file,
        )


def read_source(table: SettingsTable) -> str | None:
    """Read where the data come from; None if that is not stated.

    Raises `SettingsError` if what stands before the first ":" is none of `_SOURCES`.
    """
    if "source" not in table:
        return None
    source = table.text("source")
    if source.split(":")[0] not in _SOURCES:
        raise table.fault(f"found '{source}'; expected real, sim:WHAT or replay:WHAT", "source")
    return source


def is_sectioned(document: Mapping[str, Any]) -> bool:
    """Return whether the content of a `columns.toml` has sections of kinds of tables."""
    return bool(set(document) & set(KINDS))


def is_for(kind: str, document: Mapping[str, Any], *, beside: bool) -> bool:
    """Return whether a `columns.toml` has something for a kind of table.

    With sections it must have that of the kind. Without, it is for legs and rigs; but above the
    table's folder, if it maps columns, for legs if one is named `theta…`, else for rigs.

    Args:
        kind: One of `KINDS`.
        document: Content of the file.
        beside: Whether it is in the table's folder, not above it.
    """
    if is_sectioned(document):
        return kind in document
    columns = document.get("columns")
    if beside or not isinstance(columns, dict):
        return kind in PLAIN
    return kind == (LEGS if any(name.startswith("theta") for name in columns) else RIG)


def _gives_source(kind: str, document: Mapping[str, Any]) -> bool:
    """Return whether the source in a `columns.toml` holds for a kind of table that it does not map.

    It does for IMUs and tracks; for legs and rigs only if the file has sections, since without them
    it is for one of these two.
    """
    return kind not in PLAIN or is_sectioned(document)


def _texts(value: Any, key: str) -> list[tuple[str, str]]:
    """Return all texts in nested tables and lists, with their dotted keys."""
    if isinstance(value, str):
        return [(key, value)]
    if isinstance(value, dict):
        return [pair for name, each in value.items() for pair in _texts(each, f"{key}.{name}")]
    return [pair for each in value for pair in _texts(each, key)] if isinstance(value, list) else []
