# SPDX-License-Identifier: MIT
"""Guess the canonical columns of a table from its headers and numbers, and say what is unsure."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from model.arrays import Array
from zebro_lab.exchange.column_names import NAMES, WEAK, leg_of, plain_name, split_header
from zebro_lab.exchange.unit_guesses import UnitGuess, guess_unit
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.units import factor_to_si, is_unit_of
from zebro_lab.robot.imu_log import IMU_UNITS, is_in_g
from zebro_lab.robot.leg_log import ANGLES, LEG_UNITS
from zebro_lab.tables.columns import IMU, KINDS, LEGS, RIG, TRACK
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.rig_columns import RIG_UNITS
from zebro_lab.track.trajectory.table import MAPPED_UNITS, QUATERNION

UNITS: Final[Mapping[str, Mapping[str, str | None]]] = {
    RIG: RIG_UNITS, LEGS: LEG_UNITS, IMU: IMU_UNITS, TRACK: MAPPED_UNITS,
}  # fmt: skip
"""SI unit of each canonical column, None for text, by kind of table."""
_SHORT: Final = {"t_s": "t", "x_m": "x", "y_m": "y", "z_m": "z", "yaw_rad": "yaw"}
_SIGNED: Final = {
    "traction_force", "traction_coefficient", "slip_ratio", "roll", "pitch", "yaw", "yaw_rad",
    "y_m", *ANGLES,
    *(f"{name}_{axis}" for name in ("rate", "force") for axis in "xyz"),
}  # fmt: skip
"""Columns whose sign is a convention that no table shows."""
_ROS = re.compile(
    r"(.*[./_])?(orientation|angular_velocity|linear_acceleration)[./_][xyzw]"
    r"|(.*[./])?position[./][xyz]"
)
_UPRIGHT = re.compile(r"p_RS_R_[xyz].*|t[xyz]")
"""Positions with z up and y to the left of x, beside those of ROS: of EuRoC and TUM."""
_EVERYBODYS: Final = frozenset(("t", "x", "y", "z", "roll", "pitch", "yaw"))
"""Canonical names that other programs use, too, in other units."""
_FORCES = ("force_x", "force_y", "force_z")
_OTHER_QUANTITY: Final = {
    "omega_leg": "m/s", "omega_ground": "m/s", "speed_leg": "rad/s", "speed_ground": "rad/s",
    "traction_force": "dimensionless", "traction_coefficient": "N",
}  # fmt: skip
"""Unit by which a header that may mean a canonical column is known to mean another one."""


@dataclass(frozen=True)
class ColumnGuess:
    """Guessed column of a file for a canonical column.

    Attributes:
        name: Header in the file.
        unit: Unit, with what is known of it; None for a column of text.
        sign: Sign, 1 or -1.
        name_doubt: Why another column may be meant; "" if that is sure.
        sign_doubt: Why the sign is not sure; "" if it is.
        zero_doubt: Why the zero of an angle is not sure; "" if it is.
        nanoseconds: Header of a column of nanoseconds that belongs to this one; None without.
    """

    name: str
    unit: UnitGuess | None = None
    sign: int = 1
    name_doubt: str = ""
    sign_doubt: str = ""
    zero_doubt: str = ""
    nanoseconds: str | None = None

    @property
    def doubts(self) -> tuple[str, ...]:
        """What is not sure: "column", "unit", "sign", "zero"."""
        found = {
            "column": self.name_doubt, "unit": self.unit.doubt if self.unit else "",
            "sign": self.sign_doubt, "zero": self.zero_doubt,
        }  # fmt: skip
        return tuple(what for what, doubt in found.items() if doubt)


def guess_kind(table: RawTable) -> str:
    """Return the kind of a table: the only one of `KINDS` whose columns its headers suffice for.

    Raises:
        SettingsError: They fit no kind or several.
    """
    fitting = [kind for kind in KINDS if _is_kind(kind, guess_columns(table, kind))]
    if len(fitting) == 1:
        return fitting[0]
    found = f"may be of the kinds {' or '.join(fitting)}" if fitting else "fits no kind of table"
    raise SettingsError(
        f"{table.path} {found}, by its headers {', '.join(list(table.columns)[:8])}; say what it "
        f"is with one of {', '.join(KINDS)}",
        key="--kind",
    )


def guess_columns(table: RawTable, kind: str = RIG) -> dict[str, ColumnGuess]:
    """Guess which column of a table holds each canonical column of a kind, by canonical name.

    Columns are matched by their headers, each at most once. Of several matches the header that is
    the canonical name is taken, else the first in the table that is not in `WEAK`, else the first.
    Canonical columns without a match are omitted.

    Args:
        table: The table.
        kind: One of `KINDS`.
    """
    guesses: dict[str, ColumnGuess] = {}
    taken: set[str] = set()
    lowest_leg = min((leg[0] for name in table.columns if (leg := leg_of(name))), default=1)
    shared = (*_EVERYBODYS, *QUATERNION)
    ours = any(name in UNITS[kind] and name not in shared for name in table.columns)
    for canonical in UNITS[kind]:
        if canonical.startswith("traction_coefficient") and "traction_force" in guesses:
            continue
        fitting = [
            name for name in table.columns
            if name not in taken and _fits(table, name, canonical, kind, lowest_leg)
        ]  # fmt: skip
        fitting.sort(key=lambda name: (not is_canonical(name, canonical), _is_weak(name)))
        if fitting:
            guesses[canonical] = _guess(table, canonical, kind, fitting, ours=ours)
            taken.update((fitting[0], guesses[canonical].nanoseconds or fitting[0]))
    return _in_one_angle_unit(_in_multiples_of_g(table, _with_axes(_whole_quaternion(guesses))))


def _in_multiples_of_g(table: RawTable, guesses: dict[str, ColumnGuess]) -> dict[str, ColumnGuess]:
    """Return the guesses with the unit g for the specific force where its numbers suggest it.

    That is where all three components have numbers, none a stated unit, and the median of the
    vector's length is about 1 by `is_in_g`.
    """
    forces = {name: guesses[name] for name in _FORCES if name in guesses}
    numbers = [numbers_or_none(table, guess.name) for guess in forces.values()]
    found = [values for values in numbers if values is not None]
    stated = any(table.unit_of(guess.name, "m/s^2") for guess in forces.values())
    if stated or len(found) < len(_FORCES):
        return guesses
    if not is_in_g(float(np.nanmedian(np.linalg.norm(np.array(found), axis=0)))):
        return guesses
    unit = UnitGuess("g", "the file states none, and its length is about 1")
    return guesses | {name: replace(guess, unit=unit) for name, guess in forces.items()}


def _whole_quaternion(guesses: dict[str, ColumnGuess]) -> dict[str, ColumnGuess]:
    """Return the guesses without `qw` to `qz` unless all four of them were found.

    Three headers such as `rot_x`, `rot_y` and `rot_z` are angles about the axes instead.
    """
    if set(QUATERNION) <= guesses.keys():
        return guesses
    return {name: guess for name, guess in guesses.items() if name not in QUATERNION}


def _with_axes(guesses: dict[str, ColumnGuess]) -> dict[str, ColumnGuess]:
    """Add to `x_m`, `y_m` and `z_m` the doubt which axis is up, where a `z_m` was found.

    Canonical headers and those of ROS, EuRoC and TUM, which have z up, are not doubted.
    """
    doubt = "the file does not say which axis is up; if not z, give import --track the --plane"
    for canonical in ("x_m", "y_m", "z_m") if "z_m" in guesses else ():
        guess = guesses.get(canonical)
        if guess and not is_canonical(guess.name, canonical) and not (
            _ROS.fullmatch(guess.name) or _UPRIGHT.fullmatch(guess.name)
        ):  # fmt: skip
            doubts = f"{guess.name_doubt}; {doubt}".lstrip("; ")
            guesses[canonical] = replace(guess, name_doubt=doubts)
    return guesses


def _in_one_angle_unit(guesses: dict[str, ColumnGuess]) -> dict[str, ColumnGuess]:
    """Set degrees for every angle with a doubtful unit, if one of them was guessed in degrees."""
    angles = {
        canonical: guess for canonical, guess in guesses.items()
        if guess.unit and guess.unit.doubt and guess.unit.unit in ("rad", "deg")
    }  # fmt: skip
    if not any(guess.unit and guess.unit.unit == "deg" for guess in angles.values()):
        return guesses
    return guesses | {
        canonical: replace(guess, unit=replace(guess.unit, unit="deg"))
        for canonical, guess in angles.items() if guess.unit
    }  # fmt: skip


def numbers_or_none(table: RawTable, name: str) -> Array | None:
    """Return the numbers of a column; None if it cannot be read as numbers.

    Args:
        table: Table that has the column.
        name: Header of the column.

    Returns:
        Values by row, shape (n,), in the file's unit; None also if none is finite.
    """
    try:
        numbers = table.numbers(name)
    except DataError:
        return None
    return numbers if np.isfinite(numbers).any() else None


def is_canonical(header: str, canonical: str) -> bool:
    """Return whether a header is a canonical name or its short form, such as `x` for `x_m`."""
    return header in (canonical, _SHORT.get(canonical))


def _is_kind(kind: str, found: Mapping[str, ColumnGuess]) -> bool:
    """Return whether the columns found suffice for a table of a kind.

    A rig needs a force or a coefficient whose header is not in `WEAK`; legs all six angles; an IMU
    roll and pitch, a quaternion or all three rates; a track x and y.
    """
    if kind == RIG:
        forces = ("normal_force", "traction_force", "traction_coefficient")
        return any(not _is_weak(found[name].name) for name in forces if name in found)
    if kind == LEGS:
        return all(name in found for name in ANGLES)
    if kind == IMU:
        tilt = {"roll", "pitch"} <= found.keys() or set(QUATERNION) <= found.keys()
        return tilt or {"rate_x", "rate_y", "rate_z"} <= found.keys()
    return {"x_m", "y_m"} <= found.keys()


def _fits(table: RawTable, header: str, canonical: str, kind: str, lowest_leg: int) -> bool:
    """Return whether a header may mean a canonical column of a kind.

    It does if it is the canonical name, if it names the leg of that angle, or if a pattern of
    `NAMES` matches it as a whole, with or without its unit, unless that is of `_OTHER_QUANTITY`.

    Args:
        table: The table.
        header: Header in the file.
        canonical: Canonical name of the column.
        kind: One of `KINDS`.
        lowest_leg: Lowest number of a leg in the table's headers; 0 for legs counted from 0.
    """
    if is_canonical(header, canonical):
        return True
    if canonical in ANGLES:
        leg = leg_of(header)
        return leg is not None and leg[0] - min(lowest_leg, 1) + 1 == int(canonical[-1])
    pattern, other = NAMES[kind].get(canonical), _OTHER_QUANTITY.get(canonical)
    unit = table.unit_of(header, UNITS[RIG][canonical] or "") if other else None
    if pattern is None or (unit and other and is_unit_of(unit, other)):
        return False
    names = {split_header(header)[0], plain_name(header)}
    return any(re.fullmatch(pattern, name) for name in names)


def _is_weak(header: str) -> bool:
    """Return whether a header, without its unit, is one of `WEAK`, which may mean other columns."""
    return split_header(header)[0] in WEAK


def _guess(
    table: RawTable, canonical: str, kind: str, fitting: list[str], *, ours: bool
) -> ColumnGuess:
    """Guess unit and sign of a canonical column from the best of the headers that fit it.

    Args:
        table: The table.
        canonical: Canonical name of the column.
        kind: One of `KINDS`.
        fitting: Headers that fit, the best first; the others make the first one doubtful.
        ours: Whether the table has headers that only this project uses, so that names which other
            programs use too, such as `t` or `yaw`, are in SI with the canonical sign.
    """
    name, *others = fitting
    si_unit = UNITS[kind][canonical]
    own = is_canonical(name, canonical) and (ours or name not in _EVERYBODYS)
    known = own or _ROS.fullmatch(name) is not None
    nanoseconds = _nanoseconds(table, name) if si_unit == "s" else None
    others = [other for other in others if other != nanoseconds]
    if canonical == "traction_force" and not others:  # of a wheel the other way may be forward
        sideways = name.replace("x", "y").replace("X", "Y")
        others = [sideways] if sideways != name and sideways in table.columns else []
    doubt = "" if is_canonical(name, canonical) else _name_doubt(name, canonical, others)
    if name in table.repeated:
        doubt = "several columns have this header: give each another in the file"
    if si_unit is None:
        return ColumnGuess(name, name_doubt=doubt)
    numbers = numbers_or_none(table, name)
    unit = UnitGuess("s", "") if nanoseconds else guess_unit(table, name, si_unit, si=known)
    if canonical in QUATERNION:
        unit = UnitGuess(si_unit, "")
    if canonical in ANGLES and numbers is not None:
        numbers = numbers * factor_to_si(unit.unit, si_unit)  # to unwrap them
    sign, sign_doubt = _sign(canonical, numbers, known=known or bool(_UPRIGHT.fullmatch(name)))
    zero = "90 deg must be where the centre of the leg's arc is straight below the hip"
    return ColumnGuess(
        name, unit, sign, doubt, sign_doubt, zero if canonical in ANGLES and not known else "",
        nanoseconds,
    )  # fmt: skip


def _nanoseconds(table: RawTable, name: str) -> str | None:
    """Return the header of nanoseconds, `X_nanosec`, beside seconds `X_sec`; None without one."""
    match = re.fullmatch(r"(.*)secs?", name)
    for ending in ("nanosec", "nsec", "nsecs", "nanosecs") if match else ():
        if match and match[1] + ending in table.columns:
            return match[1] + ending
    return None


def _name_doubt(name: str, canonical: str, others: list[str]) -> str:
    """Return why another column may be meant; "" if that is sure.

    Either other headers fit too, or a leg is not named by its place, or the name is in `WEAK`.
    """
    if others:
        return f"could also be {', '.join(map(repr, others))}"
    if canonical in ANGLES and not (leg_of(name) or (0, False))[1]:
        return "the file may number or name the legs otherwise, see docs/conventions.md"
    return "the name may mean another column" if _is_weak(name) else ""


def _sign(canonical: str, numbers: Array | None, *, known: bool) -> tuple[int, str]:
    """Return the sign, 1 or -1, that makes a column canonical, and why it is in doubt, or "".

    A normal force and the speeds of the discs are positive at the median. Leg angles, unless they
    are known to be canonical, grow at the median step of the unwrapped angle; their sign stays in
    doubt, since the robot may have walked backwards. Other columns keep their sign, which is in
    doubt for those in `_SIGNED`.

    Args:
        canonical: Canonical name of the column.
        numbers: Its numbers, angles in rad, shape (n,); None if they cannot be read.
        known: Whether the header alone tells that the sign is canonical.
    """
    pressed = canonical.startswith(("normal_force", "omega_", "speed_"))
    if numbers is None:
        open_sign = pressed or (canonical in _SIGNED and not known)
        return 1, "its numbers cannot be read, which would show it" if open_sign else ""
    negative = float(np.nanmedian(numbers)) < 0
    if pressed:
        return (-1, "negative in the file") if negative else (1, "")
    if canonical not in _SIGNED or known:
        return 1, ""
    if canonical in ANGLES:
        falls = float(np.nanmedian(np.diff(np.unwrap(numbers[np.isfinite(numbers)])))) < 0
        return (-1, "falls in the file") if falls else (1, "must grow as the robot walks forward")
    return 1, "the file does not show it"
