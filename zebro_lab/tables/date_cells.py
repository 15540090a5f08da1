# SPDX-License-Identifier: MIT
"""Convert dates and times of day in a column to seconds."""

import re
from datetime import datetime
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.tables.raw_table import RawTable

CLOCK: Final = "h:m:s"
"""Unit of times of day or durations such as 12:00:00.5."""
_DATE = re.compile(r"date(?: (?P<zone>UTC|[+-]\d\d:\d\d))?")
_MONTHS: Final = (
    "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec",
)  # fmt: skip
_NAMED_MONTH = rf"^(\d\d?)-({'|'.join(_MONTHS)})-(\d{{4}})"
_DAY: Final = 86400.0  # s
_ZONE = r"(?:Z|[+-]\d\d:?\d\d)$"
_UNREAD: Final = "is not read as a date or time; write"
EXAMPLE: Final = "2026-03-04T05:06:07.5+01:00"


def is_date_unit(unit: str) -> bool:
    """Return whether a unit of `columns.toml` says that cells are dates or times of day.

    >>> [is_date_unit(unit) for unit in ("date", "date UTC", "date +01:00", "h:m:s", "s")]
    [True, True, True, True, False]
    """
    return unit == CLOCK or _DATE.fullmatch(unit) is not None


def seconds_of_dates(table: RawTable, name: str, unit: str) -> Array:
    """Return a column of dates or times of day as seconds, NaN for empty cells, shape (n,).

    Dates become seconds since 1970 (UTC). They are as ISO 8601 has them, day.month.year, or
    04-Mar-2026. A time of day that is earlier by more than 12 hours than the one before is of the
    next day.

    Args:
        table: Table with the column.
        name: Header of the column.
        unit: "date" for cells that state their time zone, "date ZONE" (UTC or +01:00) for cells
            that do not, "h:m:s" for times of day.

    Raises:
        DataError: The column is missing or of numbers; or a cell is no such date, has no time zone
            although the unit states none, or has one beside that of the unit; names the cell.
    """
    cells = table.column(name)
    if pd.api.types.is_numeric_dtype(cells) and not cells.isna().all():
        raise table.fault(f'holds numbers; expected dates, as unit = "{unit}" states', name)

    def require(good: NDArray[np.bool_], problem: str) -> None:
        table.require(name, good, lambda index: f"'{cells.iloc[index]}' {problem}")

    empty = cells.isna().to_numpy(dtype=bool)
    texts = cells.map(lambda cell: cell if isinstance(cell, str) else _iso(cell)).str.strip()
    texts = texts.mask(empty)
    if unit == CLOCK:
        found = pd.to_timedelta(texts.str.replace(",", ".", regex=False), errors="coerce")
        seconds = found.dt.total_seconds().to_numpy(dtype=float)
        require(~np.isnan(seconds) | empty, f"{_UNREAD} 12:00:00.5")
        return _past_midnight(seconds)
    zone = unit.removeprefix("date").strip() or None
    zoned = texts.str.contains(_ZONE, na=False).to_numpy(dtype=bool)
    if zone is None:
        advice = 'unit = "date UTC" or "date +01:00"'
        require(zoned | empty, f"has no time zone; state it in columns.toml: {advice}")
    else:
        require(~zoned, 'has a time zone of its own; state unit = "date" in columns.toml')
    # to YYYY-MM-DD: day.month.year, named months, slashes, decimal commas, single digits
    texts = texts.str.replace(r"^(\d\d?)\.(\d\d?)\.(\d{4})", r"\3-\2-\1", regex=True)
    texts = texts.str.replace(_NAMED_MONTH, _numbered_month, regex=True)
    texts = texts.str.replace(r"^(\d{4})/(\d\d?)/(\d\d?)", r"\1-\2-\3", regex=True)
    texts = texts.str.replace(",", ".", regex=False)
    texts = texts.str.replace(r"-(\d)(?=[-T ]|$)", r"-0\1", regex=True)
    found = pd.to_datetime(texts, format="ISO8601", utc=True, errors="coerce")
    since = (found - pd.Timestamp(0, tz="UTC")).dt.total_seconds().to_numpy(dtype=float)
    require(~np.isnan(since) | empty, f"{_UNREAD} {EXAMPLE}")
    return since - _offset(zone)


def _past_midnight(seconds: Array) -> Array:
    """Return times of day as seconds since the first midnight, shape (n,) [s]; NaN stays.

    A fall by more than half a day begins the next day.
    """
    known = np.flatnonzero(np.isfinite(seconds))
    days = np.cumsum(np.diff(seconds[known]) < -_DAY / 2)
    passed = seconds.copy()
    passed[known[1:]] += _DAY * days
    return passed


def _numbered_month(match: re.Match[str]) -> str:
    """Return a date such as 4-Mar-2026 as 2026-03-04."""
    return f"{match[3]}-{_MONTHS.index(match[2]) + 1:02d}-{int(match[1]):02d}"


def _iso(cell: object) -> object:
    """Return a date or time as text in ISO 8601, any other cell as its text."""
    return cell.isoformat() if hasattr(cell, "isoformat") else str(cell)  # pyright: ignore[reportAttributeAccessIssue]


def _offset(zone: str | None) -> float:
    """Return the offset from UTC of a zone such as "+01:00" [s]; 0 for "UTC" or None."""
    if zone in (None, "UTC"):
        return 0.0
    shift = datetime.fromisoformat(f"2000-01-01T00:00:00{zone}").utcoffset()
    return shift.total_seconds() if shift else 0.0
