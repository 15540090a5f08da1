# SPDX-License-Identifier: MIT
"""Find units: in the header of a column (brackets, slash, suffix), or in settings above it.

Text in brackets that is neither a known unit nor plainly a name is returned too: where such a
column is used, a unit must be stated for it, since numbers taken as SI could be wrong by a factor.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Final

from zebro_lab.files.units import is_unit_of, is_unit_text

_BRACKETS: Final = re.compile(r"\[([^\[\]]*)\]|\(([^()]*)\)|\{([^{}]*)\}|<([^<>]*)>")
_AT_END: Final = re.compile(r"(?:\s/\s*|,\s*|\sin\s)([^\s,]+(?:/\S+)?)\s*$")
_MULTIPLE: Final = re.compile(r"\s/\s*([^\s,]*(?:\d.*[A-Za-zµ]|[A-Za-zµ].*\d)\S*)\s*$")
_NAME: Final = re.compile(
    r"left|right|front|fore|rear|back|hind|mid(?:dle)?|cent(?:er|re)|links|rechts|vorne?|hinten|"
    r"mitte|oben|unten|top|bottom|upper|lower|legs?|bein|motor|joint|gelenk|wheel|dis[ck]|ground|"
    r"boden|sensor|channel|kanal|ch|ai|adc|axis|achse|[xyzwlr]|xyz?|roll|pitch|yaw|[fmrhv][lr]|body|"
    r"world|global|local|filtered|gefiltert|unfiltered|smoothed|mean|average|avg|mittel|rms|"
    r"measured|actual|ist|soll|set|target|abs(?:olute)?|rel(?:ative)?|total|sum|of|and|the|und|de[rs]"
    r"|n[or]|id",
    re.IGNORECASE,
)
"""Words in brackets that name something and measure nothing."""
_SPELLED_UNIT: Final = re.compile(
    r"newton|met(er|re)|gramm?|pond|se[ck]|minut|hour|stund|grad|degree|radian|volt|amp|pro[zc]ent|"
    r"percent|pound|ounce|unze|inch|zoll|foot|feet|fuß|yard|count|tick|digit|step|dyn|turn|umdreh|"
    r"revol|hertz|watt|joule|pascal|unit|einheit|raw|roh|zehntel|hundertstel|tausendstel|tenth|"
    r"hundredth|thousandth",
    re.IGNORECASE,
)
LVM_TIME: Final = ("x_value", "x value")
_MOTIVE: Final = "Format Version"
_LONG_WORD: Final = 5
"""Letters from which on a word in round brackets is a name, if it spells no unit."""
_SUFFIXES: Final = {
    "rad_s": "rad/s", "rads": "rad/s", "radps": "rad/s", "mrad_s": "mrad/s", "deg_s": "deg/s",
    "degs": "deg/s", "degps": "deg/s", "dps": "deg/s", "mdps": "mdps", "rpm": "rpm",
    "rev_s": "rev/s", "rps": "rev/s", "u_min": "rpm", "1_min": "1/min",
    "m_s2": "m/s^2", "mps2": "m/s^2", "ms2": "m/s^2", "m_s_2": "m/s^2", "mg": "mg", "g": "g",
    "rad": "rad", "mrad": "mrad", "deg": "deg", "grad": "grad", "percent": "%", "pct": "%",
    "prozent": "%", "ns": "ns", "us": "us", "µs": "us", "ms": "ms", "sec": "s", "s": "s",
    "min": "min", "kn": "kN", "dan": "daN", "cn": "cN", "mn": "mN", "un": "µN", "n": "N",
    "kgf": "kgf", "gf": "gf", "lbf": "lbf", "kg": "kg", "lb": "lb", "lbs": "lbs",
    "um": "um", "mm": "mm", "cm": "cm", "dm": "dm", "km": "km", "m": "m", "in": "in", "ft": "ft",
    "mv": "mV",
}  # fmt: skip
"""Unit of each ending of a header after "_", a blank or another mark, in lower case."""
_ALSO_NAMES: Final = frozenset({
    "s", "n", "m", "in", "ft", "min", "rad", "rads", "degs", "mg", "un", "mn", "cn", "dan", "us",
})  # fmt: skip
"""Endings that count only where the unit fits: `n_min` is least, `Drehzahl Rad` of a wheel."""
_SUBSCRIPTED: Final = re.compile(r"(?:.*_)?(?:f|force|kraft)_[ng]")
"""Headers that end in a subscript, which is no unit: `F_N` is normal, perhaps in pounds."""


def unit_in_header(header: str) -> str | None:
    """Return the unit in brackets or at the end of a header, as in `F [N]` or `F / N`; else None.

    Of text in brackets that may be a unit, but is not known, that text.

    >>> unit_in_header("FZ [N]"), unit_in_header("Zeit / ms"), unit_in_header("F (left)")
    ('N', 'ms', None)
    >>> unit_in_header("FZ [N*10]"), unit_in_header("position[0]"), unit_in_header("FZ [kN] (left)")
    ('N*10', None, 'kN')
    """
    inside = [next(filter(None, groups), "").strip() for groups in _BRACKETS.findall(header)]
    known = [text for text in inside if text and text != "1" and is_unit_text(text)]
    if known:
        return known[-1]
    if (match := _AT_END.search(header)) and match[1] != "1" and is_unit_text(match[1]):
        return match[1]
    round_ones = {groups[1].strip() for groups in _BRACKETS.findall(header)}
    unclear = [text for text in inside if not _is_name(text, in_round=text in round_ones)]
    if unclear:
        return unclear[-1]
    multiple = _MULTIPLE.search(header)
    return multiple[1] if multiple and not _is_name(multiple[1], in_round=True) else None


def suffix_in_header(header: str) -> tuple[str, str] | None:
    """Return the ending of a header that is a unit, in lower case, and that unit; None without one.

    >>> suffix_in_header("FT_mN"), suffix_in_header("omega_leg_deg_s"), suffix_in_header("FZ")
    (('mn', 'mN'), ('deg_s', 'deg/s'), None)
    """
    text = _BRACKETS.sub(" ", header).replace("μ", "µ")
    words = [word for word in re.split(r"[^0-9A-Za-zµ%°²]+", text) if word]
    plain = "_".join(words).casefold()
    for count in (3, 2, 1):
        ending = "_".join(words[-count:]).casefold().replace("μ", "µ")  # casefold makes it Greek
        if len(words) > count and ending in _SUFFIXES and not _SUBSCRIPTED.fullmatch(plain):
            return ending, "MN" if words[-1] == "MN" else _SUFFIXES[ending]
    return None


def suffix_unit(header: str, si_unit: str) -> str | None:
    """Return the unit at the end of a header, as in `FT_mN`; None without one, or if it is a name.

    A unit of another quantity is returned too, to be reported, unless the ending is also a name.

    Args:
        header: The header.
        si_unit: SI unit of what the column is used for: `omega_g` is no acceleration.

    >>> suffix_unit("az_g", "m/s^2"), suffix_unit("omega_g", "rad/s"), suffix_unit("FZ_kg", "N")
    ('g', None, 'kg')
    >>> suffix_unit("F_N", "N"), suffix_unit("FZ_N", "N")
    (None, 'N')
    """
    found = suffix_in_header(header)
    if found is None or found[1] == si_unit:
        return found and si_unit
    ending, unit = found
    if is_unit_of(unit, si_unit):
        return unit
    names = ending in _ALSO_NAMES or (ending == "g" and si_unit != "N")
    return None if names else unit


def _is_name(text: str, *, in_round: bool) -> bool:
    """Return whether text in brackets is plainly a name or an index, and no unit.

    Each of its words must be in `_NAME`, or, in round brackets, have `_LONG_WORD` letters and spell
    no unit. A text with "*", "/" or "^" is a unit; one without letters, such as an index, a name.

    Args:
        text: Text in the brackets.
        in_round: Whether the brackets are round, which hold names more often than square ones.
    """
    words = re.findall(r"[^\W\d_]+", text)
    if "*" in text or "/" in text or "^" in text:
        return False
    return all(
        _NAME.fullmatch(word)
        or (in_round and len(word) >= _LONG_WORD and not _SPELLED_UNIT.search(word))
        for word in words
    )


def stated_units(settings: Sequence[Sequence[str]], names: Sequence[str]) -> Mapping[str, str]:
    """Return the units that settings above a header state, by header.

    Those of LabVIEW stand in `Y_Unit_Label`, each in the column of its channel; a column of times
    is the first, or before each channel. That of Motive is one of all positions, `Length Units`.

    Args:
        settings: Cells of each line above the header.
        names: Header of each column.

    >>> stated_units([["Y_Unit_Label", "N"], ["X_Dimension", "Time"]], ["X_Value", "Fz", "Comment"])
    {'Fz': 'N', 'X_Value': 's'}
    >>> stated_units([["Format Version", "1.23", "Length Units", "Meters"]], ["Time", "Position X"])
    {'Position X': 'meters'}
    """
    lines = {cells[0]: list(cells[1:]) for cells in settings if len(cells) > 1}
    if _MOTIVE in lines and "Length Units" in lines[_MOTIVE][:-1]:
        unit = lines[_MOTIVE][lines[_MOTIVE].index("Length Units") + 1].casefold()
        return {name: unit for name in names if "Position" in name.split()}
    if "Y_Unit_Label" not in lines:
        return {}
    times = [name for name in names if name.casefold().startswith(LVM_TIME)]
    labels = {name: unit for name, unit in zip(names[1:], lines["Y_Unit_Label"], strict=False)
              if unit and name not in times}  # fmt: skip
    in_time = lines.get("X_Dimension", [""])[0].casefold() == "time"
    return {**labels, **(dict.fromkeys(times, "s") if in_time else {})}


def scaled(si_unit: str, unit: str) -> str:
    """Return what to try if a unit is not known or of another quantity, for messages.

    Args:
        si_unit: SI unit of the canonical column.
        unit: The unit.
    """
    if si_unit == "rad/s" and is_unit_of(unit, "m/s"):
        return "or map the speed of a surface as speed_leg or speed_ground, not omega"
    unit = "" if si_unit == "dimensionless" else f" {si_unit}"
    return f'or scale = NUMBER, unit = "{si_unit}" if 1 in the file is NUMBER{unit}'
