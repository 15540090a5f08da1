# SPDX-License-Identifier: MIT
"""Sections of a `columns.toml`: of one kind of table each, or none for a table of rig or legs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from rig.nearest_name import nearest
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.settings_table import SettingsTable

LEGS, IMU, TRACK, RIG = "legs", "imu", "track", "rig"
KINDS: Final = (LEGS, IMU, TRACK, RIG)
"""Kinds of tables, which are the names of sections."""
_PLAIN: Final = (LEGS, RIG)
"""Kinds whose columns.toml may be without sections."""
DOUBT: Final = "?"
"""End of a value that was guessed and that nobody has checked."""
_GUESSED: Final = ("columns", "constants", "runs")


def read_section(kind: str, file: Path, *, alone: bool = False) -> SettingsTable:
    """Read the entries of a `columns.toml` that are for one kind of table.

    Without any section, all entries apply to leg and rig tables, and only `source` to the others.

    Args:
        kind: One of `KINDS`.
        file: The `columns.toml`.
        alone: Whether all entries of a file without sections are for this kind.

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
    elif kind not in _PLAIN and not alone:
        entries = {}
    if not isinstance(entries, dict):
        raise SettingsError(f"found {entries!r}; expected a section [{kind}]", file=file, key=kind)
    require_checked(entries, file=file, path=path)
    source = {"source": document["source"]} if "source" in document else {}
    return SettingsTable(source | entries, file=file, path=path)


def is_sectioned(document: Mapping[str, Any]) -> bool:
    """Return whether the content of a `columns.toml` has sections of kinds of tables."""
    return bool(set(document) & set(KINDS))


def require_checked(entries: Mapping[str, Any], *, file: Path, path: str = "") -> None:
    """Check that no value ends in "?", as guesses of `zebro-lab init` do.

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


def _texts(value: Any, key: str) -> list[tuple[str, str]]:
    """Return all texts in nested tables and lists, with their dotted keys."""
    if isinstance(value, str):
        return [(key, value)]
    if isinstance(value, dict):
        return [pair for name, each in value.items() for pair in _texts(each, f"{key}.{name}")]
    return [pair for each in value for pair in _texts(each, key)] if isinstance(value, list) else []
