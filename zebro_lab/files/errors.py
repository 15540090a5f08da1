# SPDX-License-Identifier: MIT
"""Error types of `zebro_lab`; each message is one line without control characters."""

import re
from os import PathLike
from typing import Final

LONGEST: Final = 1000
"""Largest number of characters of a message that are shown; longer ones are truncated."""

# C0 and C1 control characters, line and paragraph separators, direction marks, invisible operators,
# the byte order mark, annotations, lone surrogates, tags. Joiners are kept: Persian and Hindi need
# them.
_HARMFUL = re.compile(
    "[\x00-\x1f\x7f-\x9f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e0fff]"
)


def shown(text: str) -> str:
    r"""Replace control, direction and invisible characters by Python escapes such as `\x1b`.

    Line breaks, tabs and lone surrogates are replaced too; zero-width joiners are kept.

    >>> shown("completed\nall well \x1b[31m")
    'completed\\nall well \\x1b[31m'
    """
    return _HARMFUL.sub(lambda match: ascii(match[0])[1:-1], text)


def shortened(text: str, longest: int = LONGEST) -> str:
    """Truncate a long string by replacing its middle with an ellipsis.

    Args:
        text: String to truncate.
        longest: Largest number of characters kept; the ellipsis with its spaces comes on top.

    >>> shortened("abcdefghij", 5)
    'ab … ij'
    """
    if len(text) <= longest:
        return text
    half = longest // 2
    return f"{text[:half]} … {text[-half:]}"


class ZebroLabError(Exception):
    """Root of every error that `zebro_lab` raises on purpose."""


class DataError(ZebroLabError, ValueError):
    """A table or a recording has missing or invalid content.

    The message begins with the known part of the location: file, column, row. Attributes are None
    where they are unknown or do not apply.

    Attributes:
        problem: What was found, what was expected, what to try.
        file: File that has the invalid content.
        column: Header of the column in this file.
        row: Data row, 1 for the first row below the header.
        line: Line of the text file, counted from 1; shown only with a row.
        value: Value that was found.
        unit: Unit of `value`, as in the file.

    >>> str(DataError("is not a number", file="rig.csv", column="FZ", row=3, line=4))
    "rig.csv, column 'FZ', row 3 (line 4): is not a number"
    """

    def __init__(
        self,
        problem: str,
        *,
        file: str | PathLike[str] | None = None,
        column: str | None = None,
        row: int | None = None,
        line: int | None = None,
        value: object = None,
        unit: str | None = None,
    ) -> None:
        place = [str(file)] if file is not None else []
        if column is not None:
            place.append(f"column '{column}'")
        if row is not None:
            place.append(f"row {row}" + (f" (line {line})" if line is not None else ""))
        super().__init__(_one_line(", ".join(place), problem))
        self.problem = problem
        self.file = file
        self.column = column
        self.row = row
        self.line = line
        self.value = value
        self.unit = unit


class SettingsError(ZebroLabError, ValueError):
    """A settings file or an option has an invalid value.

    Attributes:
        problem: What was found, what was expected, what to try.
        file: Settings file; None for a command-line option.
        key: Dotted key inside the file, or the option; None if it is not about a single one.

    >>> str(SettingsError("expected a number", file="columns.toml", key="runs.gap"))
    'columns.toml, runs.gap: expected a number'
    """

    def __init__(
        self, problem: str, *, file: str | PathLike[str] | None = None, key: str | None = None
    ) -> None:
        place = ", ".join(str(part) for part in (file, key) if part is not None)
        super().__init__(_one_line(place, problem))
        self.problem = problem
        self.file = file
        self.key = key


class UnitError(ZebroLabError, ValueError):
    """A unit is unknown or measures another quantity, or a quantity is not a finite number.

    Attributes:
        unit: The unit as written; "" for text without a number; the expected SI unit if the number
            is infinite or NaN.
    """

    def __init__(self, problem: str, *, unit: str) -> None:
        super().__init__(problem)
        self.unit = unit


class NotFound(ZebroLabError, FileNotFoundError):
    """A file or folder that was named does not exist."""


class AlreadyExists(ZebroLabError, FileExistsError):
    """Writing would overwrite an existing file or folder, or another process is replacing it."""


class NotWritten(ZebroLabError, OSError):
    """A result cannot be written because of an error of the file system."""


class RecordingError(ZebroLabError, OSError):
    """A run cannot be recorded or resumed, or was not recorded or done to its end."""


def _one_line(place: str, problem: str) -> str:
    """Join place and problem to one line without control characters, of at most `LONGEST`."""
    # Messages of other libraries, quoted in ours, often have several lines.
    return shortened(shown(" ".join(f"{place}: {problem}".split() if place else problem.split())))
