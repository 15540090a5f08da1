# SPDX-License-Identifier: MIT
"""Names that columns have in other programs' tables, in English and German, by kind of table."""

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from zebro_lab.tables.columns import IMU, LEGS, RIG, TRACK
from zebro_lab.tables.header_units import suffix_in_header, unit_in_header

_TIME = (
    r"t|et|time|(elapsed|relative|log|record|sample|capture|step|test)_?time|__time|(time_?)?stamp|seconds|"
    r"zeit(stempel|punkt|achse)?|messzeit|sekunden|uhrzeit|clock|(wall|local)_?(clock|time)|time_of_day|datum(_?(und_?)?(uhr)?zeit)?|"
    r"date(_?(and_?)?time)?|x_value|millis|micros|(zeit|time)_\d.*|(field_)?header_stamp(_secs?)?|time_seconds|secs?|rosbagtimestamp"
)
_SPEED = r"(omega|w|speed|rate|drehzahl|rpm|winkelgeschw(indigkeit)?|angular_(speed|velocity))"
_SURFACE = r"((surface|rim|linear|umfangs)_?)?(speed|velocity|geschw(indigkeit)?|v|u)"
_LEG_DISC = r"(l|(leg|foot|wheel)(_?disc)?|dis[ck]|(bein|fuss|rad)_?(scheibe)?)"
_GROUND = (
    r"(g|ground|ground_?disc|dis[ck]|ball|drum|roller|rail|carriage|vehicle|travel|forward|table|boden|"
    r"bodenscheibe|teller|tisch|belt|road|fahrbahn)"
)
_TURNS = rf"n_?{_LEG_DISC}"  # German for speed: n
_GROUND_TURNS = "(n|drehzahl)_?(ground|ground_?disc|belt|boden|bodenscheibe|teller|tisch|scheibe)"
_CELL = r"(_?(load_?cell|sensor|transducer|kraft(aufnehmer|sensor)|aufnehmer|messdose|kmd))?"
_ORIENTATION = r"(.*_)?(orientation|quat(ernion)?|imu_orientation|q)_?"
_RATE = r"(.*_)?(angular_velocity|gyro(scope)?|gyr|g|w|omega|drehrate|rate)_?"
_FORCE = (
    r"(.*_)?(linear_acceleration|acceleration|accel(erometer)?|acc|a|beschleunigung|"
    r"specific_force|force)_?"
)
_SD = r"(std|sd|std_?dev|standard_(deviation|error)|sem|stabw|standardabweichung|sigma)"
_MEAN = r"(_(avg|mean))?"
_TRACTION = (
    rf"(((avg|mean)_)?((ft|fx|f_t|f_x){_CELL}|(traction|tangential|longitudinal|friction|drive|driving|"
    r"tractive|frictional|pull)(_?force)?|dp|(drawbar_?)?pull|(net|gross)_traction|tractive_effort|"
    r"zugkraft|traktionskraft|tangentialkraft|l(ä|ae)ngskraft|umfangskraft|reibkraft|"
    rf"kraft_?(x|t|tangential)|force_?(x|t)){_MEAN})"
)
_COEFFICIENT = (
    r"(((avg|mean)_)?(mu|cof|(traction|friction|adhesion|drawbar_?pull)_?(coeff?(icient)?|ratio)|"
    r"coeff?(icient)?_of_(friction|traction|adhesion)|reib(ungs)?(beiwert|wert|zahl|koeffizient)|"
    rf"kraftschluss(beiwert)?|dp_w|f_?[tx]_f_?[nz]|friction){_MEAN})"
)
MEAN_SLIP: Final = (
    r"srr(_(percent|pct|prozent))?|slide_?(to_?)?roll(ing)?(_ratio)?|"
    r"((long(itudinal)?|rolling)_)?creep(age)?(_?(x|ratio))?|(xi|ξ)_?x?"
)
"""Names of slip over the mean of both speeds."""
# `_position` closes the first group.
_POSITION = r"((.*_)?(pos(ition)?|translation|p|global_position)_?"


def _position(axis: str, others: str) -> str:
    """Return a regular expression of the headers of a position along an axis.

    Args:
        axis: "x", "y" or "z".
        others: Further names, as alternatives of a regular expression.
    """
    return (
        rf"{axis}|{_POSITION}{axis})|(.*_)?{axis}(_axis)?(_global)?_?(pos(ition)?|koordinate)|"
        rf"t{axis}|p_rs_r_{axis}|{others}"
    )


NAMES: Final[Mapping[str, Mapping[str, str]]] = MappingProxyType({
    RIG: {
        "t": _TIME,
        "omega_leg": rf"{_SPEED}_?{_LEG_DISC}|{_LEG_DISC}_?{_SPEED}|{_TURNS}|drehzahl",
        "omega_ground": rf"{_SPEED}_?{_GROUND}|{_GROUND}_?{_SPEED}|{_GROUND_TURNS}",
        "speed_leg": rf"{_SURFACE}_?{_LEG_DISC}|{_LEG_DISC}_?{_SURFACE}",
        "speed_ground": rf"{_SURFACE}_?{_GROUND}|{_GROUND}_?{_SURFACE}",
        "angle_leg": r"(angle|winkel|position|pos)_leg(_?disc)?|leg_disc_(angle|position)",
        "angle_ground":
            r"(angle|winkel|position|pos)_ground(_?disc)?|ground_disc_(angle|position)",
        "radius_leg": r"(radius|r)_(l|leg|bein)",
        "radius_ground": r"(radius|r)_(g|ground|boden)",
        "slip_ratio":
            r"(kappa|slip|l(ae|ä)ngsschlupf|schlupf)(_?(ratio|inst|long|x|percent|pct|prozent|wert)"
            rf")?{_MEAN}|sl|sr|(longitudinal|wheel)_slip(_ratio)?|{MEAN_SLIP}",
        "normal_force":
            rf"((avg|mean)_)?((fn|fz|f_n|f_z){_CELL}|((ball|wheel|applied|contact|test)_)?(load|weight)|w|"
            r"normal|(normal|vertical)_?(force|load)|normalkraft|aufstandskraft|radlast|"
            rf"vertikalkraft|anpresskraft|last|kraft_?(z|n|normal)|force_?(z|n)){_MEAN}|kraft|force",
        "traction_force": _TRACTION,
        "traction_coefficient": _COEFFICIENT,
        "traction_force_sd": rf"{_TRACTION}_?{_SD}|{_SD}_?(of_)?{_TRACTION}",
        "traction_coefficient_sd": rf"{_COEFFICIENT}_?{_SD}|{_SD}_?(of_)?{_COEFFICIENT}",
        "lateral_force": r"(lateral|side|transverse)_?force|seitenkraft|querkraft",
        "run": r"run(_?(id|nr|no|number))?|versuch(s?_?(nr|nummer))?|lauf(_?nr)?",
        "slip_definition": r"slip_definition",
    },
    LEGS: {"t": _TIME},
    IMU: {
        "t": _TIME,
        **{f"q{a}": rf"{_ORIENTATION}{a}|q_rs_{a}" for a in "wxyz"},
        "roll": r"(.*_)?(roll|phi|(roll|wank)winkel)(_angle)?",
        "pitch": r"(.*_)?(pitch|theta|(pitch|nick)winkel)(_angle)?",
        "yaw": r"(.*_)?(yaw|psi|gierwinkel|heading)(_angle)?",
        **{f"rate_{a}": rf"{_RATE}{a}|w_rs_s_{a}" for a in "xyz"},
        **{f"force_{a}": rf"{_FORCE}{a}|a_rs_s_{a}" for a in "xyz"},
    },
    TRACK: {
        "t_s": rf"{_TIME}|t_s",
        "x_m": _position("x", "east(ing)?|rechtswert"),
        "y_m": _position("y", "north(ing)?|hochwert"),
        "yaw_rad": r"(.*_)?(yaw|heading|psi|gierwinkel|kurs(winkel)?)(_angle)?|angle|winkel",
        "z_m": _position("z", "height|h(ö|oe)he"),
        **{f"q{a}": rf"{_ORIENTATION}{a}|(.*_)?rot(ation)?_?{a}|q_rs_{a}" for a in "wxyz"},
    },
})  # fmt: skip
"""Names of each canonical column: a regular expression of `plain_name`, by kind of table."""

WEAK: Final = frozenset({
    "kraft", "force", "drehzahl", "angle", "winkel", "last", "load", "n_scheibe",
    "drehzahl_scheibe", "w", "weight", "pull", "friction", "ball_speed", "disc_speed", "disk_speed",
})  # fmt: skip
"""Names that may well be another column: always a guess to check."""

_SIDES = {"left": 0, "links": 0, "l": 0, "right": 1, "rechts": 1, "r": 1}
_ENDS = {
    "front": 0, "fore": 0, "vorn": 0, "vorne": 0, "f": 0, "v": 0, "middle": 1, "mid": 1, "mitte": 1,
    "m": 1, "rear": 2, "back": 2, "hind": 2, "hinten": 2, "b": 2, "h": 2,
}  # fmt: skip
_BEFORE = (
    r"(?:.*_)?(?:th|theta|leg|bein|angle|winkel|phi|q|joint|motor|axis|servo|position|pos|hip)_?"
)
_AFTER = r"(?:_(?:angle|position|pos|joint|winkel|theta))?"
_NUMBERED = re.compile(rf"{_BEFORE}(\d){_AFTER}|(\d)|l(\d)")
_LETTERED = re.compile(
    rf"(?:{_BEFORE})?(?:(?P<end>[fvmrhb])(?P<side>[lr])|(?P<side2>[lr])(?P<end2>[fmhb])){_AFTER}"
)
_GREEK: Final = str.maketrans({
    "θ": "theta", "ϑ": "theta", "φ": "phi", "ψ": "psi", "ω": "omega", "κ": "kappa", "μ": "mu",
})  # fmt: skip


def leg_of(header: str) -> tuple[int, bool] | None:
    """Return the leg that a header names, 1 to 6, and whether it names it by its place.

    None if it names none. A number is returned as written, also by programs that count from 0 or
    order the legs otherwise. Letters such as FL are read as places, but not told as such, since
    they may be meant otherwise.

    >>> leg_of("leg_front_left_joint"), leg_of("Winkel Bein 3 [°]"), leg_of("position[0]")
    ((1, True), (3, False), (0, False))
    >>> leg_of("hip_FL"), leg_of("HR"), leg_of("torque_FL")
    ((1, False), (6, False), None)
    """
    plain = split_header(header)[0]
    words = plain.split("_")
    sides = {_SIDES[w] for w in words if w in _SIDES and len(w) > 1}
    ends = {_ENDS[w] for w in words if w in _ENDS and len(w) > 1}
    if len(sides) == len(ends) == 1:
        return 2 * ends.pop() + sides.pop() + 1, True
    if match := _NUMBERED.fullmatch(plain):
        return int(next(group for group in match.groups() if group is not None)), False
    if match := _LETTERED.fullmatch(plain):
        end, side = match["end"] or match["end2"], match["side"] or match["side2"]
        return 2 * (2 if end == "r" else _ENDS[end]) + _SIDES[side] + 1, False
    return None


def split_header(header: str) -> tuple[str, str | None]:
    """Split a header, `FZ [N]`, `Zeit / ms` or `t_ms`, into a plain name and a unit, if any.

    The name is in lower case with "_" for blanks and marks.

    >>> split_header("Avg. Force [kN]"), split_header("t_ms"), split_header("position[0]")
    (('avg_force', 'kN'), ('t', 'ms'), ('position_0', None))
    """
    unit = unit_in_header(header)
    if unit is not None:
        bracketed = rf"[\[(<{{]\s*{re.escape(unit)}\s*[\])>}}]"
        if re.search(bracketed, header):
            return plain_name(re.sub(bracketed, " ", header)), unit
        before = header.removesuffix(unit).rstrip()
        return plain_name(re.sub(r"([/,]|\bin)$", "", before)), unit
    plain = plain_name(header)
    if ending := suffix_in_header(header):
        return plain.removesuffix(f"_{ending[0]}"), ending[1]
    return plain, None


def plain_name(header: str) -> str:
    """Return a header in lower case with "_" for blanks and marks, its unit included."""
    text = header.strip().casefold().translate(_GREEK)
    begins = "__" if text.startswith("__") else ""  # __time
    return begins + re.sub(r"[\s.,;:\-\[\](){}/]+", "_", text).strip("_")
