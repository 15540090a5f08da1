# SPDX-License-Identifier: MIT
"""Unit conversion: parse units and compute factors to SI."""

import difflib
import math
import re
from functools import cache
from typing import TYPE_CHECKING

from zebro_lab.files.errors import UnitError

if TYPE_CHECKING:
    from pint import UnitRegistry

_COMMON = (
    "N", "mN", "kN", "kgf", "lbf", "s", "ms", "us", "min", "rad/s", "deg/s", "rpm", "rev/s",
    "m", "cm", "mm", "in", "%", "dimensionless",
)  # fmt: skip
_NO_UNIT = {"", "-", "1"}  # how headers write that a number has no unit
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)", re.DOTALL)

_SHOWN = {"rad": (180 / math.pi, "deg"), "rad/m": (180 / math.pi, "deg/m"), "-": (100.0, "%")}


def shown_unit(unit: str) -> tuple[float, str]:
    """Return the factor to multiply by, and the unit, to show a parameter of legs and floor.

    Shown are rad and rad/m in degrees and "-" in percent; any other unit is a log of a factor.

    >>> shown_unit("-"), shown_unit("log")
    ((100.0, '%'), (1.0, 'log of factor'))
    """
    return _SHOWN.get(unit, (1.0, "log of factor"))


def factor_to_si(unit: str, si_unit: str) -> float:
    """Compute the factor that converts numbers in a unit to numbers in an SI unit.

    Angles count as a dimension here, although they are dimensionless in SI: otherwise "Hz" and
    "1/min" would be accepted for an angular speed, which is wrong by a factor of 2 pi.

    Args:
        unit: Unit as pint spells it; "", "-" and "1" mean dimensionless.
        si_unit: SI unit to convert to.

    Raises:
        UnitError: The unit is unknown or measures another quantity.

    >>> factor_to_si("mm", "m"), factor_to_si("%", "dimensionless")
    (0.001, 0.01)
    """
    found, wanted = _in_root_units(unit), _in_root_units(si_unit)
    if found[1] != wanted[1]:
        raise UnitError(
            f"unit '{unit}' cannot be converted to {si_unit}; "
            f"expected one like {', '.join(_like(wanted[1])) or si_unit}",
            unit=unit,
        )
    return found[0] / wanted[0]


def quantity_to_si(quantity: str | float, si_unit: str) -> float:
    """Convert a quantity, such as "35 mm", to a number in SI.

    Args:
        quantity: Number in SI, or a string with a number and a unit; without a unit it is in SI.
        si_unit: SI unit of the result.

    Raises:
        UnitError: The string is not a number with a unit, the number is infinite or NaN, or the
            unit is unknown or measures another quantity.

    >>> quantity_to_si("35 mm", "m"), quantity_to_si(0.035, "m")
    (0.035, 0.035)
    """
    if not isinstance(quantity, str):
        number, factor = float(quantity), 1.0
    elif match := _QUANTITY.fullmatch(quantity):
        number = float(match[1])
        factor = factor_to_si(match[2] or si_unit, si_unit)
    else:
        raise UnitError(f"'{quantity}' is not a number with a unit such as '1 {si_unit}'", unit="")
    if not math.isfinite(number):
        raise UnitError(f"{quantity} is infinite or NaN; expected a finite number", unit=si_unit)
    return number * factor


def is_unit_of(unit: str, si_unit: str) -> bool:
    """Return whether a unit can be converted to an SI unit; False for an unknown unit.

    Args:
        unit: Unit as pint spells it; "", "-" and "1" mean dimensionless.
        si_unit: SI unit to convert to.
    """
    try:
        factor_to_si(unit, si_unit)
    except UnitError:
        return False
    return True


@cache
def _registry() -> "UnitRegistry":
    from pint import UnitRegistry  # takes 0.3 s, so imported only for conversion

    registry = UnitRegistry()
    registry.define("@alias turn = rev")
    return registry


@cache
def _in_root_units(unit: str) -> tuple[float, str]:
    text = "dimensionless" if unit.strip() in _NO_UNIT else unit.strip()
    registry = _registry()
    try:
        quantity = registry.Quantity(1.0, registry.parse_units(text)).to_root_units()
    except Exception as error:  # pint answers malformed text with anything, AssertionError too
        near = difflib.get_close_matches(text, _COMMON, n=1, cutoff=0.5)
        advice = f"did you mean '{near[0]}'?" if near else f"known are {', '.join(_COMMON)}, …"
        raise UnitError(f"unknown unit '{unit}'; {advice}", unit=unit) from error
    return float(quantity.magnitude), str(quantity.units)


def _like(root_units: str) -> list[str]:
    return [unit for unit in _COMMON if _in_root_units(unit)[1] == root_units]
