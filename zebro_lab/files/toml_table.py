# SPDX-License-Identifier: MIT
"""A table of a TOML file that checks what is taken out of it and names the place of each fault."""

import json
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.known_keys import require_known
from zebro_lab.files.units import quantity_to_si


@dataclass(frozen=True)
class TomlTable:
    """One table of a file.

    Attributes:
        file: The file, for messages.
        values: What the table holds.
        where: The table's dotted key with a final dot; "" for the top.
    """

    file: Path
    values: Mapping[str, Any]
    where: str = ""

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def require_known(self, known: Collection[str]) -> None:
        """Refuse keys other than the known ones.

        Raises:
            SettingsError: A key is unknown; names the nearest known one.
        """
        require_known(self.values, known, file=self.file, where=self.where)

    def table(self, key: str) -> "TomlTable":
        """Take a table out; an empty one where it is missing.

        Raises:
            SettingsError: It is no table.
        """
        return self.as_table(key, self.values.get(key, {}))

    def as_table(self, key: str, found: object) -> "TomlTable":
        """Take a value that stands under a key for a table.

        Raises:
            SettingsError: It is none.
        """
        if not isinstance(found, dict):
            raise self.error(key, f"expected a table, found {found!r}")
        return TomlTable(self.file, found, f"{self.where}{key}.")

    def text(self, key: str, default: str | None = None) -> str:
        """Take a text out.

        Raises:
            SettingsError: It is missing without a default, or no text.
        """
        found = self._found(key, default)
        if not isinstance(found, str) or not found:
            raise self.error(key, f"expected a text, found {found!r}")
        return found

    def number(self, key: str, unit: str = "dimensionless", *, default: float | None = None,
               above: float = -math.inf) -> float:  # fmt: skip
        """Take a number in SI, or a text such as "30 mm", out.

        Args:
            key: Its key.
            unit: Its SI unit.
            default: What to return where it is missing.
            above: What it must exceed.

        Raises:
            SettingsError: It is missing without a default, no number, or too small.
        """
        number = self._quantity(key, self._found(key, default), unit)
        if not number > above:
            raise self.error(key, f"is {number:g}; expected more than {above:g}")
        return number

    def numbers(self, key: str, count: int, unit: str = "dimensionless") -> tuple[float, ...]:
        """Take a list of numbers, each as `number` takes one.

        Raises:
            SettingsError: It is missing, of another length, or holds something else.
        """
        found = self._found(key, None)
        if not isinstance(found, list) or len(found) != count:
            raise self.error(key, f"expected a list of {count} numbers, found {found!r}")
        return tuple(self._quantity(f"{key}[{i}]", each, unit) for i, each in enumerate(found))

    def error(self, key: str, problem: str) -> SettingsError:
        """Make an error that names file and key."""
        return SettingsError(problem, file=self.file, key=f"{self.where}{key}")

    def _found(self, key: str, default: object) -> object:
        if key in self.values:
            return self.values[key]
        if default is None:
            raise self.error(key, "missing")
        return default

    def _quantity(self, key: str, found: object, unit: str) -> float:
        if isinstance(found, bool) or not isinstance(found, (int, float, str)):
            raise self.error(key, f"expected a number, found {found!r}")
        try:
            return quantity_to_si(found, unit)
        except UnitError as error:
            raise self.error(key, str(error)) from error


def read_toml(file: Path, *, advice: str) -> TomlTable:
    """Read a TOML file.

    Args:
        file: The file.
        advice: What to do where there is none.

    Raises:
        NotFound: There is no such file.
        SettingsError: It cannot be read as TOML.
    """
    return TomlTable(file, read_toml_document(file, advice=advice))


def quoted(text: str) -> str:
    r"""Spell a text as TOML.

    >>> print(quoted('a "b"'))
    "a \"b\""
    """
    # TOML's escapes are JSON's, but for pairs of surrogates and for a bare DEL.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def listed(numbers: Collection[float]) -> str:
    """Spell numbers as a TOML list that reads back to twelve digits.

    >>> listed([0.1 + 0.2, 5])
    '[0.3, 5.0]'
    """
    return f"[{', '.join(spelled(number) for number in numbers)}]"


def spelled(number: float) -> str:
    """Spell a number as TOML, to twelve digits."""
    return repr(float(f"{float(number):.12g}"))
