# SPDX-License-Identifier: MIT
"""Parse the option `--thesis`: switches of the thesis's walking model."""

from dataclasses import replace
from math import degrees, radians
from types import MappingProxyType
from typing import Any, Final

from typer import BadParameter

from model.similar_name import similar_name
from model.walk.thesis_switches import ThesisSwitches

_SWITCHES: Final = MappingProxyType({
    "no-height-reset": {"reset_height": False},
    "mend-roll": {"mend_roll": True},
    "mend-slip": {"mend_slip": True},
    "mend-heading": {"mend_heading": True},
    "static-loads": {"static_loads": True},
    "contact-slip-angle": {"contact_slip_angle": True},
})  # fmt: skip
_HEADING: Final = "heading"
SWITCHES: Final = (*_SWITCHES, f"{_HEADING}=DEG")
"""Names of the switches, as they are written on the command line."""
THESIS_HELP: Final = (
    "Switches of --model thesis, with commas between them. no-height-reset: the body sinks, as in "
    "its text; mend-roll: right turns lean to their side; mend-slip: slip of legs that turn back; "
    "mend-heading: no dependence on the compass; static-loads: legs carry as in equilibrium; "
    "contact-slip-angle: lateral law as section 4-5-3 prints it; heading=DEG: yaw at the start."
)


def parse_thesis(text: str) -> ThesisSwitches:
    """Parse switches of the thesis's model, with commas between them.

    Raises:
        BadParameter: A switch is unknown, or the heading is no number of degrees within a turn.

    >>> parse_thesis("no-height-reset,heading=90").reset_height
    False
    """
    switches = ThesisSwitches()
    for each in (part.strip() for part in text.split(",")):
        switches = replace(switches, **_switched(each))
    return switches


def _switched(text: str) -> dict[str, Any]:
    name, equals, value = text.partition("=")
    if name == _HEADING and equals:
        return {"heading": _heading(value)}
    if text in _SWITCHES:
        return _SWITCHES[text]
    near = similar_name(text, SWITCHES)
    meant = "" if near is None else f"'{near}'? "
    raise BadParameter(f"'{text}' is no switch; {meant}there are {', '.join(SWITCHES)}")


def _heading(text: str) -> float:
    try:
        heading = float(text)
    except ValueError:
        heading = float("nan")
    if not -360 <= heading <= 360:
        raise BadParameter(f"heading is '{text}'; expected degrees from -360 to 360")
    return radians(heading)


def named_switches(switches: ThesisSwitches) -> tuple[str, ...]:
    """Return the switches that are set, as they are written on the command line.

    >>> named_switches(parse_thesis("mend-roll,heading=90"))
    ('mend-roll', 'heading=90')
    """
    names = [name for name, fields in _SWITCHES.items()
             if all(getattr(switches, key) == value for key, value in fields.items())]  # fmt: skip
    if switches.heading != 0:
        names.append(f"{_HEADING}={degrees(switches.heading):.6g}")
    return tuple(names)
