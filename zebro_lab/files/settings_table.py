# SPDX-License-Identifier: MIT
"""Settings files: read TOML with numbers that may carry a unit; fill values into a template."""

import math
import numbers
from collections.abc import Mapping, MutableMapping
from pathlib import Path
from typing import Any, Final

import numpy as np
import tomlkit
from tomlkit.items import InlineTable

from model.toml_table import TomlTable
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.units import factor_to_si, quantity_to_si

_NO_UNIT: Final = "dimensionless"


class SettingsTable(TomlTable):
    """One table of a TOML settings file, with unit conversion; errors are `SettingsError`.

    Takes the arguments of `TomlTable`.
    """

    error = SettingsError

    def quantity(self, key: str, unit: str, *, default: float | None = None,
                 above: float = -math.inf, least: float = -math.inf,
                 usual: float = math.inf) -> float:  # fmt: skip
        """Read a quantity: a number in SI, or a string with a unit such as "30 mm".

        Args:
            key: Key of the value.
            unit: SI unit of the result.
            default: Value if the key is missing, in SI; None if the key is required.
            above: Exclusive lower limit, in SI; holds for the default too.
            least: Inclusive lower limit, in SI; holds for the default too.
            usual: Largest absolute value of a number without a unit, as in `quantity_to_si`.

        Raises:
            SettingsError: The value is missing without a default, not a finite number (with a known
                unit of this quantity, if it is a string), below a limit, or beyond `usual`.
        """
        found = self.value(key, default)
        number = self._to_si(key, found, unit, usual)
        if number <= above:
            raise self.fault(f"is {_with_unit(number, unit)}; expected more than {above:g}", key)
        if number < least:
            raise self.fault(f"is {_with_unit(number, unit)}; expected {least:g} or more", key)
        return number

    def quantities(
        self, key: str, count: int, unit: str, *, usual: float = math.inf
    ) -> tuple[float, ...]:
        """Read a list of quantities, each in SI or a string with a unit.

        Args:
            key: Key of the list.
            count: Expected number of elements.
            unit: SI unit of the result.
            usual: As in `quantity`, of each element.

        Returns:
            The numbers in SI.

        Raises:
            SettingsError: The list is missing, of another length, or has an element that is not a
                finite number or a string with one in a known unit of this quantity, or is beyond
                `usual`.
        """
        found = self._list(key, count)
        return tuple(self._to_si(f"{key}[{i}]", each, unit, usual) for i, each in enumerate(found))

    def factor(self, key: str, unit: str) -> tuple[str, float]:
        """Read the name of a unit and compute its conversion factor to an SI unit.

        Args:
            key: Key of the unit's name.
            unit: SI unit to convert to; also the default if the key is missing.

        Returns:
            Name of the unit, and the factor from it to the SI unit.

        Raises:
            SettingsError: The value is not a string, or the unit is unknown or measures another
                quantity.
        """
        name = self.text(key, unit)
        try:
            return name, factor_to_si(name, unit)
        except UnitError as error:
            raise self.fault(str(error), key) from error

    def _to_si(self, key: str, found: object, unit: str, usual: float) -> float:
        """Convert a number, or a text with a unit, to SI.

        Raises `SettingsError`, which names the key, for any other value, as `quantity_to_si` does.
        """
        if isinstance(found, bool) or not isinstance(found, (int, float, str)):
            named = "" if unit == _NO_UNIT else f" in {unit} or a text such as '1 {unit}'"
            raise self.fault(f"found {found!r}; expected a number{named}", key)
        try:
            return quantity_to_si(found, unit, usual=usual)
        except (UnitError, OverflowError) as error:  # a whole number may be too large for a float
            raise self.fault(str(error), key) from error


def _with_unit(number: float, unit: str) -> str:
    """Format a number with its unit, if it has one, for a message."""
    return f"{number:g}" if unit == _NO_UNIT else f"{number:g} {unit}"


def read_settings(file: Path, *, advice: str) -> SettingsTable:
    """Read a TOML settings file as a table with unit conversion.

    Args:
        file: The TOML file.
        advice: What to do if the file does not exist; part of the error message.

    Returns:
        The whole file as a table.

    Raises:
        NotFound: There is no such file.
        SettingsError: The file is not regular, cannot be opened, is too large, or is not TOML.
    """
    return SettingsTable(read_toml_document(file, advice=advice), file=file)


def fill_in(template: str, values: Mapping[str, Any]) -> str:
    r"""Fill values into a TOML template whose comments and order are kept.

    Args:
        template: TOML with a placeholder value at each key; keys that it lacks are added.
        values: Values to write, tables as mappings; keys that are missing here keep their
            placeholder. Numbers other than integers are rounded to twelve significant digits, which
            removes rounding errors of unit conversion.

    Returns:
        The filled template.

    >>> fill_in("[legs]\nradius = 0  # of the arc [m]", {"legs": {"radius": 0.1 + 0.2}})
    '[legs]\nradius = 0.3  # of the arc [m]'
    """
    document = tomlkit.parse(template)
    _fill(document, values)
    return tomlkit.dumps(document)


def inline_table(values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Create a TOML inline table (on one line) of `values`, to use as a value in `fill_in`.

    Numbers are rounded as in `fill_in`.
    """
    table = tomlkit.inline_table()
    table.update(_plain(values))
    return table


def _fill(table: MutableMapping[str, Any], values: Mapping[str, Any]) -> None:
    """Write values into a table of a TOML document in place; tables in it keep their other keys."""
    for key, value in values.items():
        inner = table.get(key)
        if isinstance(value, Mapping) and isinstance(inner, MutableMapping):
            _fill(inner, value)
        else:
            table[key] = _plain(value)


def _plain(value: Any) -> Any:
    """Convert a value, also nested, for tomlkit: arrays and tuples to lists, mappings to dicts.

    Numbers other than integers are rounded to twelve significant digits; an inline table, string,
    bool or integer is returned as it is.
    """
    if isinstance(value, str | bool | numbers.Integral):
        return value
    if isinstance(value, Mapping):
        inline = isinstance(value, InlineTable)
        return value if inline else {key: _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(each) for each in value]
    return float(f"{float(value):.12g}")
