# SPDX-License-Identifier: MIT
"""Measured leg angles: a table with a time and six angles, checked and unwrapped."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from model.gait.reference import SampledReference
from model.robot import N_LEGS
from model.slip.law import Array
from zebro_lab.columns import COLUMNS_FILE, MappedColumn, nearest, require_known
from zebro_lab.errors import DataError, NotFound, SettingsError, UnitError
from zebro_lab.raw_table import RawTable
from zebro_lab.recorded_legs import is_recorded, read_recorded_legs
from zebro_lab.table_files import read_table_file
from zebro_lab.units import factor_to_si
from zebro_lab.walk_folder import PATH_CSV, cell_error, require_increasing

ANGLES = tuple(f"theta{leg}" for leg in range(1, N_LEGS + 1))
_UNITS: Mapping[str, str] = {"t": "s", **dict.fromkeys(ANGLES, "rad")}
_WIDEST_GAP = 5.0  # median steps between samples; beyond, a leg may have done anything
_LONGEST_TURN = 2.5  # rad between samples; from pi on, which way a leg turned is a guess


@dataclass(frozen=True)
class LegLog:
    """Measured leg angles.

    Attributes:
        reference: Angles over time, unwrapped, with the canonical sign.
        source: "real", "sim:what", "replay:what"; "unknown" where nobody said.
        files: Every file read.
        notes: For a person, one line each.
    """

    reference: SampledReference
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Columns:
    """Where time and angles come from."""

    mapped: Mapping[str, MappedColumn]
    source: str | None = None
    file: Path | None = None


def read_leg_log(
    path: Path, *, columns: Path | None = None, leg_sign: Sequence[int] = (1,) * N_LEGS
) -> LegLog:
    """Read leg angles over time from CSV or Parquet: `t` [s] and `theta1` to `theta6` [rad].

    Other names and units are mapped by a `columns.toml`, beside the table or as named. Angles may
    be wrapped to one turn or not.

    Args:
        path: The table; a walk folder, whose path.csv holds the same columns; or a recorded run,
            whose counts become angles with the profile that it keeps.
        columns: A `columns.toml` in place of the one beside the table.
        leg_sign: 1 or -1 for each leg, which its angles are multiplied with; see robot.toml.

    Raises:
        NotFound: A file does not exist.
        SettingsError: The `columns.toml` says something that cannot be followed.
        DataError: A leg is missing, a cell holds no finite number, time does not increase or has
            a gap, or a leg turns too far between samples; names file, row and column.
    """
    if is_recorded(path):
        table, files, mapping = *read_recorded_legs(path), _read_columns(None)
        file = files[0]
    else:
        file = _table_of(path)
        table, files = read_table_file(file), (file,)
        mapping = _read_columns(_columns_file(file, columns))
    t, *angles = (_numbers(table, name, mapping) for name in _UNITS)
    time_column = mapping.mapped["t"].name
    if len(t) < 2:
        raise DataError(f"has {len(t)} row; a leg log needs two or more", file=file)
    require_increasing(table, time_column, t)
    _require_no_gap(table, time_column, t)
    raw = np.column_stack(angles) * np.asarray(leg_sign, dtype=float)
    theta = np.unwrap(raw, axis=0)
    _require_unwrapped(table, mapping, theta)
    return LegLog(
        SampledReference(t, theta),
        source=mapping.source or table.source or "unknown",
        files=(*files, *([mapping.file] if mapping.file else [])),
        notes=(*table.notes, *_notes(t, raw, theta)),
    )


def _table_of(path: Path) -> Path:
    if not path.is_dir():
        return path
    if (path / PATH_CSV).is_file():
        return path / PATH_CSV
    raise DataError(
        f"is a folder without a {PATH_CSV}; name a CSV or Parquet file with t and "
        f"{ANGLES[0]} to {ANGLES[-1]}",
        file=path,
    )


def _columns_file(table: Path, named: Path | None) -> Path | None:
    beside = table.parent / COLUMNS_FILE
    return named or (beside if beside.is_file() else None)


def _read_columns(file: Path | None) -> _Columns:
    canonical = {name: MappedColumn(name, unit) for name, unit in _UNITS.items()}
    if file is None:
        return _Columns(canonical)
    try:
        document = tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except FileNotFoundError as error:
        raise NotFound(f"{file}: no such file; expected a {COLUMNS_FILE}") from error
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SettingsError(f"cannot be read as TOML: {error}", file=file) from error
    require_known(document, ("source", "columns"), file=file, where="")
    tables = document.get("columns", {})
    if not isinstance(tables, dict):
        raise SettingsError("expected a table", file=file, key="columns")
    require_known(tables, _UNITS, file=file, where="columns.")
    mapped = {name: _mapped(name, table, file) for name, table in tables.items()}
    source = document.get("source")
    return _Columns({**canonical, **mapped}, None if source is None else str(source), file)


def _mapped(name: str, table: Any, file: Path) -> MappedColumn:
    key = f"columns.{name}"
    if isinstance(table, str):  # theta1 = "th1": a name alone, in SI
        table = {"name": table}
    if not isinstance(table, dict):
        raise SettingsError("expected a table with name, unit, sign", file=file, key=key)
    require_known(table, ("name", "unit", "sign"), file=file, where=f"{key}.")
    sign, unit = table.get("sign", 1), str(table.get("unit", _UNITS[name]))
    if sign not in (1, -1) or isinstance(sign, bool):
        raise SettingsError(f"{sign!r} is neither 1 nor -1", file=file, key=f"{key}.sign")
    try:
        factor = sign * factor_to_si(unit, _UNITS[name])
    except UnitError as error:
        raise SettingsError(str(error), file=file, key=f"{key}.unit") from error
    return MappedColumn(str(table.get("name", name)), unit, factor)


def _numbers(table: RawTable, name: str, columns: _Columns) -> Array:
    mapped = columns.mapped[name]
    if mapped.name not in table.columns and mapped.name not in table.repeated:
        what = "time" if name == "t" else f"angle of leg {name[-1]}"
        raise DataError(
            f"missing, the {what}; {nearest(mapped.name, list(table.columns))}; map it in "
            f"{COLUMNS_FILE} as [columns.{name}]",
            file=table.path, column=mapped.name,
        )  # fmt: skip
    values = table.numbers(mapped.name)
    good = np.isfinite(values)
    if not good.all():
        index = int(np.argmin(good))
        found = "infinite" if np.isinf(values[index]) else "empty"
        raise cell_error(
            table, mapped.name, index,
            f"is {found}; expected a number in {mapped.unit}: delete the rows before or after it, "
            "or fill it",
        )  # fmt: skip
    return values * mapped.factor


def _require_no_gap(table: RawTable, column: str, t: Array) -> None:
    steps = np.diff(t)
    usual = float(np.median(steps))
    wide = steps > _WIDEST_GAP * usual
    if wide.any():
        index = int(np.argmax(wide)) + 1
        raise cell_error(
            table, column, index,
            f"time jumps from {t[index - 1]:g} to {t[index]:g} s, where samples are {usual:.4g} s "
            "apart; split the log there and predict each part",
        )  # fmt: skip


def _require_unwrapped(table: RawTable, columns: _Columns, theta: Array) -> None:
    turns = np.abs(np.diff(theta, axis=0))
    if not (turns > _LONGEST_TURN).any():
        return
    row, leg = (int(i[0]) for i in np.nonzero(turns > _LONGEST_TURN))
    raise cell_error(
        table, columns.mapped[ANGLES[leg]].name, row + 1,
        f"leg {leg + 1} turns by {turns[row, leg]:.3g} rad since the sample before; from half a "
        "turn on nobody can tell which way: check its unit, or log faster",
    )  # fmt: skip


def _notes(t: Array, raw: Array, theta: Array) -> list[str]:
    rate = (len(t) - 1) / (t[-1] - t[0])
    notes = [f"leg log: {len(t)} samples over {t[-1] - t[0]:.4g} s, about {rate:.4g} Hz"]
    if np.any(raw != theta):
        notes.append("leg log: angles were wrapped to a turn, now unwrapped")
    backward = [str(leg + 1) for leg in range(N_LEGS) if theta[-1, leg] < theta[0, leg] - np.pi]
    if backward:
        notes.append(
            f"leg log: legs {', '.join(backward)} turn backwards; is their sign right? "
            "(legs.sign in robot.toml, or sign in columns.toml)"
        )
    return notes
