# SPDX-License-Identifier: MIT
"""Unit conversion: parse units and compute factors to SI."""

import math
import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from model.similar_name import similar_name
from zebro_lab.files.errors import SettingsError, UnitError, shortened

if TYPE_CHECKING:
    from pint import UnitRegistry

_COMMON = (
    "N", "mN", "kN", "kgf", "lbf", "s", "ms", "us", "min", "rad/s", "deg/s", "rpm", "rev/s",
    "m", "cm", "mm", "in", "%", "dimensionless",
)  # fmt: skip
_NO_UNIT = {"", "-", "1", "–", "none", "ratio", "unitless"}  # how headers write that there is none
_MISREAD = {"Grad": "deg", "Grad/s": "deg/s", "U/min": "rpm", "Upm": "rpm", "RPM": "rpm"}
"""Spellings in which pint would see another unit: gigarad for the German degree."""
_TURNS = re.compile(r"1?/[Mm]in|[Mm]in(?:\^|\*\*)?-1|[Mm]in⁻¹")
"""Spellings of revolutions per minute (DIN 1301), for angular speeds only."""
_SPELLINGS = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sek": "s",
    "sekunde": "s", "sekunden": "s", "sek.": "s", "msec": "ms",
    "usec": "us", "nsec": "ns", "kph": "km/h", "kmh": "km/h", "km/hr": "km/h", "mps": "m/s",
    "fps": "ft/s", "°": "deg", "rev/min": "rpm", "tr/min": "rpm", "rad/sec": "rad/s",
    "deg/sec": "deg/s", "°/s": "deg/s", "newton": "N", "newtons": "N", "lbs": "lbf",
    "prozent": "%", "pct": "%", "deg c": "degC", "deg f": "degF", "°c": "degC", "inches": "in",
    "millimeter": "mm", "meter": "m",
    "kp": "kgf", "p": "gf", "dps": "deg/s", "mdps": "mdeg/s", "rps": "rev/s",
}  # fmt: skip
"""What strangers write for units that pint does not know, in lower case."""
_BASES = (
    r"s|[Ss]ecs?|[Ss]econds?|[Ss]ek|Sekunden?|ms|msec|us|usec|µs|ns|nsec|min|h|hr|hrs"
    r"|m|dm|mm|cm|km|um|µm|in|inch|ft|(?:[Mm]illi|[Cc]enti|[Kk]ilo)?[Mm](?:et(?:er|re)s?)"
    r"|(?:[kMmcdµunGh]|da)?N|(?:[Kk]ilo|[Mm]illi)?[Nn]ewtons?|lbf?|lbs|ozf|oz|kgf?|gf|kp|p|mg|g|dyn"
    r"|rad|[Rr]adians?|mrad|deg|[Dd]egrees?|[Gg]rad|°|rev|turns?|tr|rpm|RPM|Upm|dps|mdps|rps"
    r"|Hz|kHz|mV|µV|V|mA|A|W|kW|J|K"
    r"|°C|degC|deg ?[CF]|°F|C|F|Pa|kPa|hPa|MPa|bar|mbar|psi|%|percent|[Pp]rozent|Nm|N-m|N\*m|N m"
    r"|pix|px|pixels?|ticks|counts?|digits?|kph|mph|kmh|mps|U|G|T|uT|µT|mT|dB|ohm|Ohm|Ω|raw"
)
_POWER = r"(?:\^?-?[1-4]|[²³]|⁻[¹²]|\*\*-?[1-4])?"
_UNIT_TEXT = re.compile(rf"(?:1|{_BASES}){_POWER}(?:[/*·. ](?:{_BASES}){_POWER})*")
_BOUNDED = re.compile(
    r"(?:[^\W\d_]\w*+|1(?!\w)|[-/*·.() °%‰µ⁻]|(?:\*\*|\^) *[-+]?\d{1,2}(?!\w| *(?:\*\*|\^)))*"
)
"""Names, 1, and powers of up to two digits, no tower of them: pint multiplies out any number."""
_LONGEST: Final = 60
"""Largest length of the text of a unit [characters]."""
_SMALLER = {"m": ("cm", "mm"), "kg": ("g", "g"), "dimensionless": ("%", "%")}
"""Unit that a number above `usual` is probably in: if up to ten times as large, and if larger."""
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)", re.DOTALL)

_SHOWN = {"rad": (180 / math.pi, "deg"), "rad/m": (180 / math.pi, "deg/m"), "-": (100.0, "%")}


def shown_unit(unit: str) -> tuple[float, str]:
    """Return the factor to multiply by, and the unit, to show a parameter of legs and floor.

    Shown are rad and rad/m in degrees and "-" in percent; any other unit is a log of a factor.

    >>> shown_unit("-"), shown_unit("log")
    ((100.0, '%'), (1.0, 'log of factor'))
    """
    return _SHOWN.get(unit, (1.0, "log of factor"))


def unit_symbol(unit: str) -> str:
    """Return the short form of a slip parameter's unit, as tables and pictures show it.

    >>> unit_symbol("1/newton"), unit_symbol("dimensionless")
    ('1/N', '-')
    """
    return "-" if unit == "dimensionless" else unit.replace("newton", "N")


def factor_to_si(unit: str, si_unit: str) -> float:
    """Compute the factor that converts numbers in a unit to numbers in an SI unit.

    Angles count as a dimension here, although they are dimensionless in SI: otherwise "Hz" would be
    accepted for an angular speed, which is wrong by a factor of 2 pi. Of an angular speed "1/min"
    is revolutions per minute, see `counts_turns`; of an acceleration "g" is standard gravity, and
    "mg" a thousandth of it.

    Args:
        unit: Unit as pint spells it; "", "-" and "1" mean dimensionless.
        si_unit: SI unit to convert to.

    Raises:
        UnitError: The unit is unknown or measures another quantity.

    >>> factor_to_si("mm", "m"), factor_to_si("%", "dimensionless")
    (0.001, 0.01)
    """
    if unit.strip() == "g" and si_unit == "m/s^2":
        unit = "g_0"  # of an acceleration never the gram
    elif unit.strip() == "mg" and si_unit == "m/s^2":
        unit = "mg_0"
    elif counts_turns(unit, si_unit):
        unit = "rpm"
    found, wanted = _in_root_units(unit), _in_root_units(si_unit)
    if found[1] != wanted[1]:
        raise UnitError(
            f"unit '{unit}' cannot be converted to {si_unit}; "
            f"expected one like {', '.join(_like(wanted[1])) or si_unit}",
            unit=unit,
        )
    return found[0] / wanted[0]


def counts_turns(unit: str, si_unit: str) -> bool:
    """Return whether a unit such as "1/min" is one of angular speed, in revolutions per minute.

    >>> counts_turns("1/min", "rad/s"), counts_turns("Hz", "rad/s"), counts_turns("1/min", "Hz")
    (True, False, False)
    """
    return si_unit == "rad/s" and _TURNS.fullmatch(unit.replace(" ", "")) is not None


def may_be_gradian(unit: str) -> bool:
    """Return whether a unit is "grad", the gradian in SI but for many Germans the degree."""
    return unit.strip() == "grad"


def is_unit_text(text: str) -> bool:
    """Return whether a text is written as units in headers are, whether pint knows it or not.

    >>> [is_unit_text(text) for text in ("m/s²", "deg C", "-", "kappa", "FZ")]
    [True, True, True, False, False]
    """
    text = text.strip()
    return text.casefold() in _NO_UNIT or _UNIT_TEXT.fullmatch(text) is not None


def quantity_to_si(quantity: str | float, si_unit: str, *, usual: float = math.inf) -> float:
    """Convert a quantity, such as "35 mm", to a number in SI.

    Args:
        quantity: Number in SI, or a string with a number and a unit; without a unit it is in SI.
        si_unit: SI unit of the result.
        usual: Largest absolute value of a number without a unit; a larger one is taken for a
            number in another unit. With its unit it is accepted.

    Raises:
        UnitError: The string is not a number with a unit, the number is infinite or NaN, the unit
            is unknown or measures another quantity, or a number without a unit is beyond `usual`.

    >>> quantity_to_si("35 mm", "m"), quantity_to_si(0.035, "m")
    (0.035, 0.035)
    """
    unit = ""
    if not isinstance(quantity, str):
        number, factor = float(quantity), 1.0
    elif match := _QUANTITY.fullmatch(quantity):
        number, unit = float(match[1]), match[2]
        factor = factor_to_si(unit or si_unit, si_unit)
    else:
        raise UnitError(f"'{quantity}' is not a number with a unit such as '1 {si_unit}'", unit="")
    if not math.isfinite(number):
        raise UnitError(f"{quantity} is infinite or NaN; expected a finite number", unit=si_unit)
    if abs(number) > usual and not unit:
        smaller = _SMALLER.get(si_unit, (si_unit, si_unit))[abs(number) >= 10 * usual]
        unit = "" if si_unit == "dimensionless" else f" {si_unit}"
        raise UnitError(
            f"is {number:g}{unit}, which is improbable; expected at most {usual:g}{unit} "
            f'from a number without a unit: write it with its unit, such as "{number:g} {smaller}" '
            f'(or "{number:g} {si_unit}")',
            unit=si_unit,
        )
    return number * factor


def option_to_si(text: str, si_unit: str, *, key: str, usual: float = math.inf) -> float:
    """Convert the value of an option, such as "35 mm", to a number in SI.

    Args:
        text: Number with a unit, or without one in SI.
        si_unit: SI unit of the result.
        key: The option, for the error.
        usual: As in `quantity_to_si`.

    Raises:
        SettingsError: The value cannot be converted, as in `quantity_to_si`.
    """
    try:
        return quantity_to_si(text, si_unit, usual=usual)
    except UnitError as error:
        raise SettingsError(str(error), key=key) from error


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
    """Return the unit registry of pint, with "turn" as another name of a revolution."""
    from pint import UnitRegistry  # takes 0.3 s, so imported only for conversion

    registry = UnitRegistry()
    registry.define("@alias turn = rev")
    return registry


@cache
def _in_root_units(unit: str) -> tuple[float, str]:
    """Return the factor of a unit to pint's root units (m, g, s, rad), and their product as text.

    Two units measure the same quantity if these texts are equal.

    Raises:
        UnitError: The unit is unknown.
    """
    text = _MISREAD.get(unit.strip(), unit.strip())
    text = "dimensionless" if text.casefold() in _NO_UNIT else text
    registry = _registry()
    try:
        quantity = registry.Quantity(1.0, _parsed(text)).to_root_units()
    except Exception as error:
        near = similar_name(text[:_LONGEST], _COMMON)
        advice = f"did you mean '{near}'?" if near else f"known are {', '.join(_COMMON)}, …"
        raise UnitError(
            f"unknown unit '{shortened(unit, _LONGEST)}'; {advice}", unit=unit
        ) from error
    return float(quantity.magnitude), str(quantity.units)


def _parsed(text: str) -> Any:
    """Parse a unit with pint, in the spelling of strangers as well; raise any exception if not."""
    if len(text) > _LONGEST or not _BOUNDED.fullmatch(text):
        raise ValueError("is too long, or would be multiplied out")
    try:
        return _registry().parse_units(text)
    except Exception:  # pint answers malformed text with anything, AssertionError too
        return _registry().parse_units(_respelled(text))


def _respelled(unit: str) -> str:
    """Return a unit in the spelling of pint, where strangers write it in another way.

    >>> [_respelled(unit) for unit in ("Sek.", "m/s2", "N-m", "°/s")]
    ['s', 'm/s^2', 'N*m', 'deg/s']
    """
    text = unit.replace("\u03bc", "u").replace("µ", "u").replace("·", "*")
    text = text.replace("²", "^2").replace("³", "^3").replace("⁻¹", "^-1").replace("⁻²", "^-2")
    text = re.sub(r"(?<=[A-Za-z])-(?=[A-Za-z])", "*", text)
    text = re.sub(r"(?<=[A-Za-z])(?=[234](?!\d))", "^", text)
    if text.casefold() in _SPELLINGS:
        return _SPELLINGS[text.casefold()]
    return "/".join(_SPELLINGS.get(part.casefold(), part) for part in text.split("/"))


def _like(root_units: str) -> list[str]:
    """Return common units with the same root units, as examples for a message."""
    return [unit for unit in _COMMON if _in_root_units(unit)[1] == root_units]
