# SPDX-License-Identifier: MIT
"""Validated access to a table of a TOML file: each key is read once, unknown keys are an error."""

import sys
import tomllib
from collections.abc import Callable
from os import PathLike
from typing import Any, ClassVar, Final, Self, TypeVar

from model.similar_name import nearest, similar_name

MOST_BYTES: Final = 1 << 20
"""Largest size of TOML that is parsed; a calibration of 8000 runs has this size [bytes]."""
LONGEST: Final = 10_000
"""Largest number of values in a series."""
Choice = TypeVar("Choice", bound=str)


def parse_toml(data: bytes) -> dict[str, Any]:
    """Parse TOML of at most `MOST_BYTES`.

    Args:
        data: Content of a file, in UTF-8 with or without a byte order mark.

    Raises:
        ValueError: The content is larger, not UTF-8, not TOML, nested too deeply, or has a whole
            number of more than 64 bits; the message does not name the file.

    >>> parse_toml(b"mass = 2.17")
    {'mass': 2.17}
    """
    if len(data) > MOST_BYTES:
        raise ValueError(f"holds more than {MOST_BYTES >> 20} MiB, the most that is read")
    try:
        entries = tomllib.loads(data.decode("utf-8-sig"))
        _require_64_bits(entries)
    except RecursionError as error:
        raise ValueError("is nested too deeply") from error
    return entries


def _require_64_bits(value: object, key: str = "") -> None:
    """Raise `ValueError` if a value, or one nested in it, is an integer of more than 64 bits."""
    if isinstance(value, int) and value.bit_length() > 64:  # TOML has no larger ones
        raise ValueError(f"{key} is a whole number of more than 64 bits; expected a smaller one")
    items = value.items() if isinstance(value, dict) else ()
    if isinstance(value, list):
        items = ((key, each) for each in value)
    for name, each in items:
        _require_64_bits(each, name)


class TomlTable:
    """One table of a TOML file, of which each key is read and removed exactly once.

    A key that remains after all known keys have been read is an error, which `finish` raises. The
    methods that read a key raise the `error` of their subclass where the key is missing without a
    default, or its value has the wrong type or range.

    Args:
        entries: Keys and values of the table, as parsed; copied.
        file: File that holds the table, for messages.
        path: Dotted name of the table inside the file; empty for the whole file.

    Attributes:
        error: Type of the errors; takes the problem, `file` and `key`.
    """

    error: ClassVar[Callable[..., Exception]]

    def __init__(
        self, entries: dict[str, Any], *, file: str | PathLike[str], path: str = ""
    ) -> None:
        self.file = file
        self.path = path
        self._entries = dict(entries)
        self._known: dict[str, None] = {}
        self._tables: list[TomlTable] = []

    def __contains__(self, key: str) -> bool:
        self._known[key] = None
        return key in self._entries

    @property
    def empty(self) -> bool:
        """Return whether the table has no key that has not been read yet."""
        return not self._entries

    @property
    def unread(self) -> tuple[str, ...]:
        """Keys that have not been read yet, in the file's order."""
        return tuple(self._entries)

    def fault(self, problem: str, key: str | None = None) -> Exception:
        """Return, without raising, an error that names the file and the key.

        Args:
            problem: What was found and what was expected.
            key: Key in this table; None for the table itself.
        """
        return self.error(problem, file=self.file, key=self.dotted(key))

    def dotted(self, key: str | None) -> str | None:
        """Return the dotted name of a key, or for None of this table; None for the whole file."""
        return ".".join(part for part in (self.path, key) if part) or None

    def table(self, key: str) -> Self:
        """Read a nested table; an absent one gives an empty table."""
        return self.as_table(key, self.value(key, {}))

    def as_table(self, key: str, value: object, *, expected: str = "a table") -> Self:
        """Wrap a value of this table as a nested table, which `finish` then checks as well.

        Args:
            key: Key that the value was read from.
            value: The value; anything but a dictionary is an error.
            expected: Expected kind of value, for the message.
        """
        if not isinstance(value, dict):
            raise self.fault(f"found {value!r}; expected {expected}", key)
        table = type(self)(value, file=self.file, path=self.dotted(key) or "")
        self._tables.append(table)
        return table

    def value(self, key: str, default: object = None) -> Any:
        """Read a value of any type.

        Args:
            key: Name of the key.
            default: Value of an absent key; None where the key is required.
        """
        if key not in self and default is None:
            near = similar_name(key, self._entries)
            hint = f"; found '{near}': did you mean '{key}'?" if near else ""
            raise self.fault(f"is missing{hint}", key)
        return self._entries.pop(key, default)

    def text(self, key: str, default: str | None = None, *, least: int = 0) -> str:
        """Read a string.

        Args:
            key: Name of the key.
            default: Value of an absent key; None where the key is required.
            least: Least number of characters.
        """
        value = self.value(key, default)
        if not isinstance(value, str) or len(value) < least:
            expected = "a text that is not empty" if value == "" else "a text"
            raise self.fault(f"found {value!r}; expected {expected}", key)
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """Read a list of strings, or one string as a list of one; an absent key gives none."""
        value = self.value(key, [])
        texts = [value] if isinstance(value, str) else value
        if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
            raise self.fault(f"found {value!r}; expected a text or a list of texts", key)
        return tuple(texts)

    def choice(
        self, key: str, choices: tuple[Choice, ...], default: Choice | None = None
    ) -> Choice:
        """Read a string that must be one of several allowed ones.

        Args:
            key: Name of the key.
            choices: Allowed values.
            default: Value of an absent key; None where the key is required.
        """
        value = self.value(key, default)
        for choice in choices:
            if value == choice:
                return choice
        raise self.fault(f"found {value!r}; expected one of {', '.join(choices)}", key)

    def names(self, key: str, known: tuple[str, ...]) -> tuple[str, ...]:
        """Read a list of known names, and drop duplicates.

        Args:
            key: Name of the key; an absent one gives an empty list.
            known: Allowed names.
        """
        value = self.value(key, [])
        if not isinstance(value, list) or not all(item in known for item in value):
            raise self.fault(f"found {value!r}; expected a list of names: {', '.join(known)}", key)
        return tuple(dict.fromkeys(value))

    def flag(self, key: str, default: bool) -> bool:  # noqa: FBT001, RUF100 - a value, no switch
        """Read a boolean.

        Args:
            key: Name of the key.
            default: Value of an absent key.
        """
        value = self.value(key, default)
        if not isinstance(value, bool):
            raise self.fault(f"found {value!r}; expected true or false", key)
        return value

    def whole(self, key: str, default: int | None = None, *, least: int = 0, most: int) -> int:
        """Read an integer in a range.

        Args:
            key: Name of the key.
            default: Value of an absent key; None where the key is required.
            least: Smallest allowed value.
            most: Largest allowed value.
        """
        value = self.value(key, default)
        if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
            expected = f"a whole number, {least} to {most}" if least < most else f"{least}"
            raise self.fault(f"found {value!r}; expected {expected}", key)
        return value

    def number(self, key: str, default: float | None = None) -> float:
        """Read a finite number; a boolean is an error.

        Args:
            key: Name of the key.
            default: Value of an absent key; None where the key is required.
        """
        return self._finite(self.value(key, default), key)

    def positive(self, key: str, default: float | None = None) -> float:
        """Read a finite number above 0.

        Args:
            key: Name of the key.
            default: Value of an absent key; None where the key is required.
        """
        value = self.number(key, default)
        if value <= 0:
            raise self.fault(f"found {value:g}; expected a number above 0", key)
        return value

    def positive_or_none(self, key: str) -> float | None:
        """Read a finite number above 0; None where the key is absent."""
        return self.positive(key) if key in self else None

    def numbers(self, key: str, count: int) -> tuple[float, ...]:
        """Read a required list of finite numbers.

        Args:
            key: Name of the key.
            count: Required length of the list.
        """
        return tuple(self._finite(item, key) for item in self._list(key, count))

    def wholes(self, key: str, *, least: int = 0, most: int) -> tuple[int, ...]:
        """Read a required list of integers, of any length.

        Args:
            key: Name of the key.
            least: Smallest allowed value.
            most: Largest allowed value.
        """
        value = self.value(key)
        items: list[Any] = value if isinstance(value, list) else [None]
        if any(type(item) is not int or not least <= item <= most for item in items):
            raise self.fault(
                f"found {value!r}; expected a list of whole numbers from {least} to {most}", key
            )
        return tuple(items)

    def signs(self, key: str, count: int) -> tuple[int, ...]:
        """Read a required list of signs, each 1 or -1.

        Args:
            key: Name of the key.
            count: Required length of the list.
        """
        values = self._list(key, count)
        if any(isinstance(value, bool) or value not in (-1, 1) for value in values):
            raise self.fault(f"found {values}; expected a list of {count} signs, each 1 or -1", key)
        return tuple(int(value) for value in values)

    def sign(self, key: str) -> int:
        """Read a sign, 1 or -1; an absent key gives 1."""
        value = self.value(key, 1)
        if isinstance(value, bool) or value not in (-1, 1):
            raise self.fault(f"found {value!r}; expected 1 or -1", key)
        return int(value)

    def series(self, key: str) -> tuple[float, ...]:
        """Read 1 to `LONGEST` numbers: a list, or a table of `first`, `last` and `count`.

        The table means `count` (at least 2) equidistant numbers, first and last included.
        """
        value = self.value(key)
        if isinstance(value, dict):
            return self._even(self.as_table(key, value))
        if not isinstance(value, list) or not 1 <= len(value) <= LONGEST:
            raise self.fault(
                f"found {value!r}; expected a list of 1 to {LONGEST} numbers, or a table such as "
                "{ first = 0.0, last = 1.0, count = 62 }",
                key,
            )
        return tuple(self._finite(item, key) for item in value)

    def finish(self) -> None:
        """Check that every key was read, here and in the nested tables that were read.

        Raises:
            Exception: A key was not read; the message names the nearest of the keys that were
                looked up.
        """
        for key in self._entries:
            raise self.fault(f"unknown key; {nearest(key, self._known)}", key)
        for table in self._tables:
            table.finish()

    def _list(self, key: str, count: int) -> list[Any]:
        """Read a required list of `count` values of any type."""
        value = self.value(key)
        if not isinstance(value, list) or len(value) != count:
            raise self.fault(f"found {value!r}; expected a list of {count} numbers", key)
        return value

    def _finite(self, value: Any, key: str) -> float:
        """Convert a value of the key to a float; anything but a finite number is an error."""
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if is_number and abs(value) <= sys.float_info.max:
            return float(value)
        raise self.fault(f"found {value!r}; expected a finite number", key)

    @staticmethod
    def _even(table: "TomlTable") -> tuple[float, ...]:
        """Return the equidistant numbers that a table of `series` describes, ends included."""
        count = table.whole("count", least=2, most=LONGEST)
        first, last = table.number("first"), table.number("last")
        step = (last - first) / (count - 1)
        return (*(first + i * step for i in range(count - 1)), last)
