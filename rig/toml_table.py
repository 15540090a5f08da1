# SPDX-License-Identifier: MIT
"""A table of a TOML file out of which each key is taken once, checked, and unknown keys refused."""

import difflib
import math
from os import PathLike
from typing import Any, Final, Self, TypeVar

import numpy as np

from rig.errors import ProfileError
from rig.nearest_name import nearest

LONGEST: Final = 10_000
"""Most numbers of a series."""
Choice = TypeVar("Choice", bound=str)


class TomlTable:
    """One table of a file, out of which each key is taken exactly once.

    What is left when all that is known has been taken is a fault: `finish` names it. The methods
    that take a key raise `ProfileError` (a subclass, its own error) where the key is missing
    without a default or holds something else than it should.

    Args:
        entries: The table.
        file: Where it stands, for messages.
        path: Dotted name of the table inside the file; empty for the whole file.
    """

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
        """Tell whether nothing is left to take."""
        return not self._entries

    @property
    def left(self) -> tuple[str, ...]:
        """Name the keys that were not taken yet, in the file's order."""
        return tuple(self._entries)

    def fault(self, problem: str, key: str | None = None) -> Exception:
        """Make an error that names the file and the key."""
        return ProfileError(problem, file=self.file, key=self.dotted(key))

    def dotted(self, key: str | None) -> str | None:
        """Return the name of a key in the whole file; None for the whole file itself."""
        return ".".join(part for part in (self.path, key) if part) or None

    def table(self, key: str) -> Self:
        """Take a table; an absent one is empty."""
        return self.as_table(key, self.value(key, {}))

    def as_table(self, key: str, value: object, *, expected: str = "a table") -> Self:
        """Return a value that was found at a key as a table.

        Args:
            key: Where it stands.
            value: What stands there.
            expected: What should stand there, for the message.
        """
        if not isinstance(value, dict):
            raise self.fault(f"found {value!r}; expected {expected}", key)
        table = type(self)(value, file=self.file, path=self.dotted(key) or "")
        self._tables.append(table)
        return table

    def value(self, key: str, default: object = None) -> Any:
        """Take whatever stands at a key, or the default; without either the key is missing."""
        if key not in self and default is None:
            near = difflib.get_close_matches(key, self._entries, n=1, cutoff=0.8)
            hint = f"; found '{near[0]}': did you mean '{key}'?" if near else ""
            raise self.fault(f"is missing{hint}", key)
        return self._entries.pop(key, default)

    def text(self, key: str, default: str | None = None, *, least: int = 0) -> str:
        """Take a text of so many characters or more."""
        value = self.value(key, default)
        if not isinstance(value, str) or len(value) < least:
            raise self.fault(f"found {value!r}; expected a text", key)
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """Take a list of texts, or one text; an absent one is empty."""
        value = self.value(key, [])
        texts = [value] if isinstance(value, str) else value
        if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
            raise self.fault(f"found {value!r}; expected a list of texts", key)
        return tuple(texts)

    def choice(
        self, key: str, choices: tuple[Choice, ...], default: Choice | None = None
    ) -> Choice:
        """Take one of several texts."""
        value = self.value(key, default)
        for choice in choices:
            if value == choice:
                return choice
        raise self.fault(f"found {value!r}; expected one of {', '.join(choices)}", key)

    def names(self, key: str, known: tuple[str, ...]) -> tuple[str, ...]:
        """Take a list of known names, each once; an absent one is empty."""
        value = self.value(key, [])
        if not isinstance(value, list) or not all(item in known for item in value):
            raise self.fault(f"found {value!r}; expected a list of {', '.join(known)}", key)
        return tuple(dict.fromkeys(value))

    def flag(self, key: str, default: bool) -> bool:  # noqa: FBT001, RUF100 - a value, no switch
        """Take true or false."""
        value = self.value(key, default)
        if not isinstance(value, bool):
            raise self.fault(f"found {value!r}; expected true or false", key)
        return value

    def whole(self, key: str, default: int | None = None, *, least: int = 0, most: int) -> int:
        """Take a whole number in a range, both ends included."""
        value = self.value(key, default)
        if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
            raise self.fault(f"found {value!r}; expected a whole number, {least} to {most}", key)
        return value

    def number(self, key: str, default: float | None = None) -> float:
        """Take a finite number."""
        return self._finite(self.value(key, default), key)

    def positive(self, key: str, default: float | None = None) -> float:
        """Take a number above 0."""
        value = self.number(key, default)
        if value <= 0:
            raise self.fault(f"found {value:g}; expected a number above 0", key)
        return value

    def positive_or_none(self, key: str) -> float | None:
        """Take a number above 0; None where it is absent."""
        return self.positive(key) if key in self else None

    def numbers(self, key: str, count: int) -> tuple[float, ...]:
        """Take so many finite numbers."""
        return tuple(self._finite(item, key) for item in self._list(key, count))

    def wholes(self, key: str, *, most: int) -> tuple[int, ...]:
        """Take a list of whole numbers from 0 to `most`."""
        value = self.value(key)
        items: list[Any] = value if isinstance(value, list) else [None]
        if any(type(item) is not int or not 0 <= item <= most for item in items):
            raise self.fault(f"found {value!r}; expected whole numbers, 0 to {most}", key)
        return tuple(items)

    def signs(self, key: str, count: int) -> tuple[int, ...]:
        """Take so many signs, each 1 or -1."""
        values = self._list(key, count)
        if any(isinstance(value, bool) or value not in (-1, 1) for value in values):
            raise self.fault(f"found {values}; expected {count} times 1 or -1", key)
        return tuple(int(value) for value in values)

    def sign(self, key: str, default: int = 1) -> int:
        """Take a sign, 1 or -1."""
        value = self.value(key, default)
        if isinstance(value, bool) or value not in (-1, 1):
            raise self.fault(f"found {value!r}; expected 1 or -1", key)
        return int(value)

    def series(self, key: str) -> tuple[float, ...]:
        """Take a list of numbers, or an even one as a table of `first`, `last` and `count`."""
        value = self.value(key)
        if isinstance(value, dict):
            return self._even(self.as_table(key, value))
        if not isinstance(value, list) or not 1 <= len(value) <= LONGEST:
            raise self.fault(
                f"found {value!r}; expected numbers, or {{ first = 0.0, last = 1.0, count = 62 }}",
                key,
            )
        return tuple(self._finite(item, key) for item in value)

    def finish(self) -> None:
        """Raise where keys are left that nobody took, here or in a table that was taken.

        Raises:
            ProfileError: There is one; the nearest known key is named.
        """
        for key in self._entries:
            raise self.fault(f"unknown key; {nearest(key, self._known)}", key)
        for table in self._tables:
            table.finish()

    def _list(self, key: str, count: int) -> list[Any]:
        value = self.value(key)
        if not isinstance(value, list) or len(value) != count:
            raise self.fault(f"found {value!r}; expected a list of {count} numbers", key)
        return value

    def _finite(self, value: object, key: str) -> float:
        if isinstance(value, int | float) and not isinstance(value, bool):
            number = float(value)
            if math.isfinite(number):
                return number
        raise self.fault(f"found {value!r}; expected a finite number", key)

    @staticmethod
    def _even(table: "TomlTable") -> tuple[float, ...]:
        count = table.whole("count", least=2, most=LONGEST)
        return tuple(np.linspace(table.number("first"), table.number("last"), count).tolist())
