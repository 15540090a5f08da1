# SPDX-License-Identifier: MIT
"""Read text files of lines of numbers, such as TUM, KITTI and EuRoC trajectories."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from model.arrays import Array
from model.counted import counted
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import read_text

_BRACKET = re.compile(r"\s+(?=[\[(])")


@dataclass(frozen=True)
class NumberLines:
    """Lines of equally many numbers.

    Attributes:
        file: The file.
        values: The numbers, shape (n, columns).
        lines: Line of each row in the file, counted from 1, shape (n,).
        separator: "," or ";" between numbers; None for white space.
        header: Words of the last comment line before the numbers if they are as many as the
            columns, else empty.
    """

    file: Path
    values: Array
    lines: Sequence[int]
    separator: str | None
    header: tuple[str, ...]

    def fault(self, problem: str, index: int) -> DataError:
        """Return, without raising, an error that names a row, counted from 0."""
        return DataError(problem, file=self.file, row=index + 1, line=self.lines[index])


def read_number_lines(path: Path) -> NumberLines | None:
    """Read a text file of numbers; None if its first line that is no comment has other words.

    Empty lines and those that begin with # are skipped. Numbers are separated by commas, by
    semicolons, or by white space.

    Raises:
        NotFound: There is no such file.
        DataError: The file is no text or too large, has no numbers, a line has more or fewer
            numbers than the first or a word that is none, or a number is not finite.
    """
    # Not splitlines: it also splits at characters that editors do not count as line ends.
    texts = [text.strip() for text in re.split(r"\r\n|\n|\r", read_text(path))]
    kept = [i for i, text in enumerate(texts) if text and not text.startswith("#")]
    if not kept:
        raise DataError("has no pose; expected lines of numbers, or a table", file=path)
    first = texts[kept[0]]
    separator = next((sign for sign in (";", ",") if sign in first), None)
    if _numbers(_words(first, separator)) is None:
        return None
    rows = _rows(path, [(i + 1, texts[i]) for i in kept], separator)
    comment = next((text for text in texts[: kept[0]][::-1] if text.startswith("#")), "")
    header = tuple(_words(_BRACKET.sub("", comment.lstrip("# ")), separator))
    lines = [i + 1 for i in kept]
    matching = header if len(header) == rows.shape[1] else ()
    numbers = NumberLines(path, rows, lines, separator, matching)
    finite = np.isfinite(rows).all(axis=1)
    if not finite.all():
        raise numbers.fault("a number is not finite; leave such poses out", int(np.argmin(finite)))
    return numbers


def _rows(path: Path, texts: Sequence[tuple[int, str]], separator: str | None) -> Array:
    """Convert lines to numbers, shape (n, columns); raise for the first that does not fit."""
    count = len(_words(texts[0][1], separator))
    rows = []
    for row, (line, text) in enumerate(texts, start=1):
        words = _words(text, separator)
        numbers = _numbers(words)
        if numbers is None or len(numbers) != count:
            found = f"{counted(len(words), 'word')}, not all numbers" if numbers is None else (
                f"{counted(len(words), 'number')}"
            )  # fmt: skip
            raise DataError(
                f"found {found}; expected {counted(count, 'number')} as in the first line; "
                "correct or delete the line",
                file=path, row=row, line=line,
            )  # fmt: skip
        rows.append(numbers)
    return np.array(rows)


def _words(text: str, separator: str | None) -> list[str]:
    words = [word.strip() for word in text.split(separator)]
    return words[:-1] if separator and words and not words[-1] else words


def _numbers(words: Sequence[str]) -> list[float] | None:
    try:
        return [float(word) for word in words]
    except ValueError:
        return None
