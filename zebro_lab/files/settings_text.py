# SPDX-License-Identifier: MIT
"""Write settings as commented TOML: a template with its values filled in."""

import numbers
from collections.abc import Mapping, MutableMapping
from typing import Any

import numpy as np
import tomlkit
from tomlkit.items import InlineTable


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
