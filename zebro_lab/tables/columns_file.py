# SPDX-License-Identifier: MIT
"""Read and check a `columns.toml`: its section for a kind of table, and the map of each column.

The keys are described in docs/formats.md; `zebro-lab init FILE` writes a commented example.
"""

import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from model.similar_name import nearest
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.folder_manifest import result_kind
from zebro_lab.files.settings_table import SettingsTable
from zebro_lab.files.units import factor_to_si
from zebro_lab.tables.columns import (
    CANONICAL,
    COLUMNS_FILE,
    Columns,
    MappedColumn,
    RigErrorsStated,
    RunRule,
    parse_definition,
    scaled,
)
from zebro_lab.tables.date_cells import is_date_unit
from zebro_lab.tables.row_conditions import read_row_conditions
from zebro_lab.tables.table_kinds import KINDS, PLAIN, RIG, gives_source, is_for, is_sectioned

DOUBT: Final = "?"
"""End of a value that was guessed and that nobody has checked."""
_GUESSED: Final = ("columns", "constants", "runs")

_CONSTANTS = {"radius_leg": "m", "radius_ground": "m"}
LARGEST_LOAD_CELL_ERROR = 0.2
"""Largest relative error or crosstalk of a load cell that a number without a unit can state [-]."""
_LOAD_CELL = {
    "zero_stability": "N",
    "gain_sd": "dimensionless",
    "bias_sd": "N",
    "crosstalk_sd": "dimensionless",
}
LARGEST_RIG_ERROR = {"m": 0.005, "dimensionless": 0.2}
"""Largest standard deviation of a rig's error that a number without a unit can state, by unit."""
_RIG_ERRORS = {
    "radius": "m",
    "radius_ratio": "dimensionless",
    "rolling_resistance": "dimensionless",
    "run_out": "m",
}
_SOURCES = ("real", "sim", "replay", "import", "mixed", "unknown")
"""Kinds of source; `import` and `mixed` only stand beside exported tables."""


def read_columns(file: Path) -> Columns:
    """Read and check a `columns.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file cannot be read as TOML, has an unknown key, unit or value, or more
            than one run rule.
    """
    return parse_columns(read_section(RIG, file))


def parse_columns(table: SettingsTable) -> Columns:
    """Parse and check the content of a `columns.toml`.

    Args:
        table: Content of the file, or a section of it; no other keys are allowed.

    Raises:
        SettingsError: It has an unknown key, unit or value, or more than one run rule.
    """
    columns = table.table("columns")
    columns_file = Columns(
        file=Path(table.file),
        source=_source(table),
        sheet=table.text("sheet") if "sheet" in table else None,
        columns={
            name: parse_mapped_column(columns, name, column.unit)
            for name, column in CANONICAL.items()
            if name in columns
        },
        constants=_quantities(table.table("constants"), _CONSTANTS),
        runs=_runs(table),
        keep=read_row_conditions(table.table("rows")),
        load_cell=_load_cell(table.table("load_cell")),
        priors=_priors(table.table("priors")),
        rig_errors=_rig_errors(table.table("rig_errors")),
    )
    table.finish()
    return columns_file


def parse_mapped_column(columns: SettingsTable, name: str, si_unit: str | None) -> MappedColumn:
    """Parse header, unit, scale and sign of one mapped column, and the definition of a slip ratio.

    By default the header is the canonical name, the unit SI, scale and sign 1.

    Args:
        columns: Section with an entry for the column: a table, or only the header as a string.
        name: Canonical name of the column.
        si_unit: SI unit of the column; None if its cells are text.

    Raises:
        SettingsError: Header, unit, scale, sign or slip definition is invalid.
    """
    found = columns.value(name)
    if isinstance(found, str):  # t = "ET": only a header, in SI
        found = {"name": found}
    table = columns.as_table(name, found, expected="a header, or a table with name, unit, sign")
    stated = si_unit is not None and "unit" in table
    unit, factor = _unit(table, si_unit) if si_unit else ("", 1.0)
    sign, scale = (_sign(table), _scale(table, unit if stated else "")) if si_unit else (1, 1.0)
    offset = table.quantity("offset", si_unit) if si_unit and "offset" in table else 0.0
    is_time = si_unit == "s" and "nanoseconds" in table
    nanoseconds = table.text("nanoseconds", least=1) if is_time else None
    definition = None
    if name == "slip_ratio" and "definition" in table:
        key = table.dotted("definition") or ""
        definition = parse_definition(table.value("definition"), file=Path(table.file), key=key)
    header = table.text("name", name)
    factor *= sign * scale
    return MappedColumn(header, unit, factor, definition, stated, offset, nanoseconds, scale)


def read_nearest(kind: str, folder: Path) -> SettingsTable | None:
    """Read the entries for a kind of table of the nearest `columns.toml`; None without one.

    The source is that of the nearest one that states a source, which may be another file.

    Args:
        kind: One of `KINDS`.
        folder: Folder of the table.

    Raises:
        SettingsError: As `read_section` and `nearest_columns`.
    """
    file, stated = nearest_columns(kind, folder), _nearest_source(kind, folder)
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


def nearest_columns(kind: str, folder: Path) -> Path | None:
    """Find the `columns.toml` for a kind of table: in its folder, or in the nearest one above.

    One that has nothing for this kind is passed over, but taken, for its source, if there is no
    other. One without sections above the table's folder is for legs if it maps their angles, else
    for rigs. Results of commands have their own headers: for them nothing above is looked up.

    Args:
        kind: One of `KINDS`.
        folder: Folder of the table.

    Raises:
        SettingsError: A `columns.toml` on the way cannot be read as TOML.
    """
    found = _documents(folder)
    fits = (file for file, content, beside in found if is_for(kind, content, beside=beside))
    others = (file for file, content, _ in _documents(folder) if gives_source(kind, content))
    return next(fits, None) or next(others, None)


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
    mapping, stated = nearest_columns(kind, table.parent), _nearest_source(kind, table.parent)
    notes = []
    if mapping and not mapping.is_relative_to(root) and _has_entries(kind, mapping):
        notes += [f"{table.name}: columns are those of {mapping}, the nearest for {kind} above it"]
    if stated and not stated[0].is_relative_to(root):
        notes += [f"{table.name}: its source, {stated[1]}, is stated in {stated[0]}, above it"]
    return tuple(notes)


def _has_entries(kind: str, file: Path) -> bool:
    return bool(set(read_section(kind, file).left) - {"source"})


def _nearest_source(kind: str, folder: Path) -> tuple[Path, str] | None:
    """Return the nearest `columns.toml` that states a source for a kind of table, and that."""
    for file, document, beside in _documents(folder):
        if not (gives_source(kind, document) or is_for(kind, document, beside=beside)):
            continue
        for entries, path in ((document.get(kind), kind), (document, "")):
            if isinstance(entries, dict) and "source" in entries:
                table = SettingsTable(entries, file=file, path=path)
                return file, (_source(table) or "") if kind == RIG else table.text("source")
    return None


def _documents(folder: Path) -> Iterator[tuple[Path, dict[str, Any], bool]]:
    """Yield each `columns.toml` in a folder and above, its content, and whether it is in it."""
    for each in (folder, *_above(folder)):
        if (file := each / COLUMNS_FILE).is_file():
            advice = f"expected a {COLUMNS_FILE}"
            yield file, read_toml_document(file, advice=advice), each == folder


def _above(folder: Path) -> Iterator[Path]:
    """Yield the folders above one, named as it is; of a result of a command none."""
    if result_kind(folder) is not None:
        return
    working = Path.cwd()
    for each in folder.resolve().parents:
        is_within = each.is_relative_to(working) and not folder.is_absolute()
        yield each.relative_to(working) if is_within else each


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


def _unit(table: SettingsTable, si_unit: str) -> tuple[str, float]:
    unit = table.text("unit") if "unit" in table else si_unit
    if si_unit == "s" and is_date_unit(unit):
        return unit, 1.0
    try:
        return unit, factor_to_si(unit, si_unit)
    except UnitError as error:
        raise table.fault(f"{error}, {scaled(si_unit)}", "unit") from error


def _scale(table: SettingsTable, unit: str) -> float:
    """Read the number that converts the file's numbers to the unit, which must be stated then."""
    if "scale" not in table:
        return 1.0
    if not unit or is_date_unit(unit):
        found = f"the unit '{unit}'" if unit else "no unit"
        raise table.fault(f'stands beside {found}; expected one, such as unit = "ms"', "scale")
    return table.quantity("scale", "dimensionless", above=0.0)


def _sign(table: SettingsTable) -> int:
    """Read a sign: a number, or a text as where a question mark was deleted."""
    if "sign" not in table:
        return 1
    found = table.value("sign")
    if isinstance(found, bool) or found not in (1, -1, "1", "+1", "-1"):
        raise table.fault(f"found {found!r}; expected 1 or -1", "sign")
    return int(found)


def _source(table: SettingsTable) -> str | None:
    if "source" not in table:
        return None
    source = table.text("source")
    if source.split(":")[0] not in _SOURCES:
        raise table.fault(f"found '{source}'; expected real, sim:WHAT or replay:WHAT", "source")
    return source


def _runs(table: SettingsTable) -> RunRule:
    runs = table.table("runs")
    given = [key for key in ("by", "gap", "each_row") if key in runs]
    if len(given) > 1:
        raise table.fault(f"found {' and '.join(given)}; keep only one of them", "runs")
    return RunRule(
        by=runs.texts("by"),
        gap=runs.quantity("gap", "s", above=0.0) if "gap" in runs else None,
        each_row=runs.flag("each_row", False),
    )


def _quantities(table: SettingsTable, units: Mapping[str, str]) -> dict[str, float]:
    return {key: table.quantity(key, unit) for key, unit in units.items() if key in table}


def _load_cell(table: SettingsTable) -> dict[str, float]:
    usual = {"dimensionless": LARGEST_LOAD_CELL_ERROR}
    return {
        key: table.quantity(key, unit, least=0.0, usual=usual.get(unit, math.inf))
        for key, unit in _LOAD_CELL.items()
        if key in table
    }


def _priors(table: SettingsTable) -> tuple[str, ...]:
    """Return each prior as one text: a Gaussian `NAME = MEAN ± SD`, a family `NAME ~ FAMILY(…)`."""
    texts = {key: table.text(key, least=1) for key in table.left}
    return tuple(
        f"{key} {'~' if '(' in text else '='} {text.lstrip('~= ')}" for key, text in texts.items()
    )


def prior_entry(text: str) -> tuple[str, str]:
    """Return a prior as key and text of `[priors]`, from one text of `Columns.priors`."""
    name, value = re.split(r" [=~] ", text, maxsplit=1)
    return name, value


def _rig_errors(table: SettingsTable) -> RigErrorsStated:
    stated = {
        key: table.quantity(key, unit, above=0.0, usual=LARGEST_RIG_ERROR[unit])
        for key, unit in _RIG_ERRORS.items()
        if key in table
    }
    return RigErrorsStated(**stated)


def _texts(value: Any, key: str) -> list[tuple[str, str]]:
    """Return all texts in nested tables and lists, with their dotted keys."""
    if isinstance(value, str):
        return [(key, value)]
    if isinstance(value, dict):
        return [pair for name, each in value.items() for pair in _texts(each, f"{key}.{name}")]
    return [pair for each in value for pair in _texts(each, key)] if isinstance(value, list) else []
