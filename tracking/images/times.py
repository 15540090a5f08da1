# SPDX-License-Identifier: MIT
"""Times of photographs: from EXIF, a table, or a regular interval."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.counted import counted
from tracking.errors import PhotoError, TimesError
from tracking.images.read import open_picture
from tracking.images.stamps import fit_interval

MOST_TABLE = 16 << 20
"""Largest size of a table of times that is read: some hundred thousand photographs [bytes]."""
_MOST_DIGITS = 9  # of a fraction of a second
_HEADER = "(the header is row 1)"
_EXIF_FOLDER, _TAKEN, _FRACTION, _CHANGED = 0x8769, 0x9003, 0x9291, 0x0132


@dataclass(frozen=True)
class PhotoTimes:
    """Times of photographs.

    Attributes:
        t: Times, shape (n,) [s]: as read from EXIF by the camera's clock since 1970, from an
            interval since the first photograph, from a table as written there.
        sd: Standard deviation of each time, shape (n,) [s].
        source: Where the times come from, in words, for the report.
    """

    t: Array
    sd: Array
    source: str


def exif_time(path: Path) -> tuple[float, float] | None:
    """Read the time of a photograph from EXIF: time taken, else time of last change.

    Args:
        path: The file.

    Returns:
        Seconds since 1970 by the camera's clock, taken as UTC [s], and the step of the stamp: 1 s,
        or less where EXIF has a fraction of a second, of up to 9 digits [s]. None where the picture
        cannot be read or EXIF has no valid time.

    Raises:
        OSError: The folder of the file may not be searched.
    """
    try:
        with open_picture(path) as picture:
            exif = picture.getexif()
            details = exif.get_ifd(_EXIF_FOLDER)
    except PhotoError:
        return None
    text = details.get(_TAKEN) or exif.get(_CHANGED)
    if not text:
        return None
    try:
        taken = datetime.strptime(str(text).strip("\0 "), "%Y:%m:%d %H:%M:%S").replace(tzinfo=UTC)
    except ValueError:
        return None
    digits = str(details.get(_FRACTION, "")).strip("\0 ")
    if not digits.isdecimal() or len(digits) > _MOST_DIGITS:
        return taken.timestamp(), 1.0
    step = 10.0 ** -len(digits)
    return taken.timestamp() + int(digits) * step, step


def times_from_exif(paths: Sequence[Path]) -> PhotoTimes:
    """Read the times of photographs from EXIF; fit a regular interval to stamps in whole seconds.

    Where no interval fits, 0.5 s is added to each stamp, with a standard deviation of 0.29 s. If
    all stamps have fractions, not all 0, half their step is added, and none is fitted.

    Args:
        paths: The photographs, at least one, in order of time.

    Raises:
        TimesError: When a photograph has no EXIF time or cannot be read.
        OSError: As `exif_time`.
    """
    stamps = [exif_time(path) for path in paths]
    without = [path.name for path, stamp in zip(paths, stamps, strict=True) if stamp is None]
    if without:
        raise TimesError(
            f"{without[0]} and {len(without) - 1} others have no EXIF time; give the interval of "
            f"the timer (--interval SECONDS) or a table of times (--times FILE)"
            if len(without) > 1
            else f"{without[0]} has no EXIF time; remove it, or give --interval or --times"
        )
    t = np.array([stamp[0] for stamp in stamps if stamp is not None])
    step = np.array([stamp[1] for stamp in stamps if stamp is not None])
    # A clock that stores "00" in every photograph has whole seconds only.
    if step.max(initial=0.0) < 1.0 and not np.allclose(t % 1.0, 0.0):
        return PhotoTimes(t + step / 2, step / math.sqrt(12), "EXIF with fractions of a second")
    fit = fit_interval(t)
    if fit is None:
        return PhotoTimes(
            t + 0.5, np.full(len(t), 1 / math.sqrt(12)), "EXIF in whole seconds, no interval"
        )
    return PhotoTimes(
        fit.t, fit.sd, f"EXIF in whole seconds with an interval of {fit.interval:.3f} s fitted"
    )


def times_from_interval(count: int, interval: float, *, jitter: float = 0.0) -> PhotoTimes:
    """Compute the times 0, `interval`, 2 `interval`, ... of photographs by a regular timer.

    Args:
        count: Number of photographs.
        interval: Interval of the timer [s].
        jitter: Standard deviation given to each time [s].

    Raises:
        TimesError: When the interval is not positive.
    """
    if not interval > 0:
        raise TimesError(f"the interval (--interval) is {interval:g} s; expected more than 0 s")
    return PhotoTimes(
        interval * np.arange(count), np.full(count, float(jitter)), f"interval of {interval:g} s"
    )


def times_from_table(table: Path, paths: Sequence[Path]) -> PhotoTimes:
    """Read times of photographs from a CSV file.

    Args:
        table: The file, with columns `photo` (file name), `t_s` [s] and optionally `t_sigma`, the
            standard deviation [s]; an empty or missing number is 0, of two rows the last counts.
        paths: The photographs whose times are returned, in this order.

    Raises:
        TimesError: When the file cannot be read, exceeds `MOST_TABLE` or has no rows, a column or
            the row of a photograph is missing, or any row has too many cells or a number that is
            not finite.
    """
    if table.exists() and not table.is_file():  # a FIFO would block until there is a writer
        raise TimesError(f"{table} is not a file; expected a table of times")
    try:
        if table.stat().st_size > MOST_TABLE:
            raise TimesError(f"{table} has more than {MOST_TABLE >> 20} MB, too many for times")
        with table.open(newline="", encoding="utf-8-sig") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise TimesError(f"{table} cannot be read: {error.strerror}") from error
    except (csv.Error, ValueError) as error:
        raise TimesError(f"{table} cannot be read as CSV in UTF-8: {error}") from error
    long = [line for line, row in enumerate(rows, 2) if None in row]
    if long:
        raise TimesError(f"{table}, row {long[0]} {_HEADER}: has more cells than the header")
    if not rows or not {"photo", "t_s"} <= set(rows[0]):
        found = f"the columns {', '.join(rows[0])}" if rows else "no rows"
        raise TimesError(f"{table} has {found}; expected columns photo, t_s, optionally t_sigma")
    times = {row["photo"]: _numbers(table, line, row) for line, row in enumerate(rows, 2)}
    missing = [path.name for path in paths if path.name not in times]
    if missing:
        lack = f"{counted(len(missing), 'photograph')} without a row"
        raise TimesError(f"{table} has no row for {missing[0]}; {lack}: add them, or delete those")
    pairs = np.array([times[path.name] for path in paths]).reshape(-1, 2)
    return PhotoTimes(pairs[:, 0], pairs[:, 1], f"table {table.name}")


def _numbers(table: Path, line: int, row: dict[str, str]) -> tuple[float, float]:
    """Parse `t_s` and `t_sigma` of one row, 0 where empty.

    Raises:
        TimesError: One of them is not a finite number.
    """
    numbers, place = [], f"{table}, row {line} {_HEADER}"
    for column in ("t_s", "t_sigma"):
        text = row.get(column) or "0"
        try:
            numbers.append(float(text))
        except ValueError as error:
            raise TimesError(f"{place}, {column}: '{text}' is not a number in s") from error
        if not math.isfinite(numbers[-1]):
            raise TimesError(f"{place}, {column}: found '{text}'; expected a finite number in s")
    return numbers[0], numbers[1]
