# SPDX-License-Identifier: MIT
"""Warn of leg angles whose sign, zero, order or unit is probably not the one that is assumed."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from model.arrays import Array
from model.gait.leg_faults import DirectionFault, LegFault, SignFault, ZeroFault, leg_faults
from model.gait.leg_motion import LegMotion, leg_motion
from model.gait.leg_order import ORDERS, OrderFault
from model.gait.reference import SampledReference
from model.robot import N_LEGS

WARNING: Final = "WARNING: leg log: "
"""Beginning of each warning, which commands print among their notes."""
_FASTEST: Final = 4.0  # turns per second; fast running robots with such legs stay below
_SHOWN_ORDERS: Final = 2
_CLOSE: Final = 15.0  # to a multiple of 90 degrees, which is then meant [deg]


def leg_warnings(
    log: SampledReference,
    *,
    leg_sign: Sequence[int] = (1,) * N_LEGS,
    leg_offset: Array | None = None,
    columns: Path | None = None,
) -> tuple[str, ...]:
    """Return a warning of each fault that leg angles seem to have, or a note on turning back.

    Each line says what was seen, what was expected, and the change that would make it consistent.
    If the legs turn faster than `_FASTEST`, the warning of that is the only one. Empty if they turn
    too little to tell.

    Args:
        log: Leg angles over time, as in the log.
        leg_sign: Signs that are still to be applied, shape (6,).
        leg_offset: Offsets that are added to the angles after that, shape (6,) [rad]; None for 0.
        columns: The `columns.toml` that the log was read with; None if it is not known.
    """
    theta = log.theta * np.asarray(leg_sign) + (0.0 if leg_offset is None else leg_offset)
    rate = float(np.median(np.abs(theta[-1] - theta[0]))) / (2 * np.pi * (log.t[-1] - log.t[0]))
    if rate > _FASTEST:
        return (_too_fast(rate),)
    motion = leg_motion(theta)
    if motion is None:
        return ()
    faults = leg_faults(motion)
    if not faults:
        return _backward(motion)
    named = "the columns.toml of the log's table" if columns is None else str(columns)
    return tuple(_text(fault, named) for fault in faults)


def _too_fast(rate: float) -> str:
    """Return a warning of legs that turn faster than any robot's, as of degrees taken for rad."""
    return (
        f"{WARNING}the legs make {rate:.3g} turns a second; expected at most {_FASTEST:g}: are the "
        'angles in degrees? If so, state unit = "deg" for theta1 to theta6 in columns.toml'
    )


def _text(fault: LegFault, columns: str) -> str:
    """Return the warning of one fault; `columns` names the `columns.toml` to correct."""
    match fault:
        case SignFault(legs):
            return _sign(legs, columns)
        case DirectionFault(legs):
            return (
                f"{WARNING}{_named(legs)} {_verb(legs, 'turn')} against the other legs of the "
                f"side; expected one direction on each side: check the sign of {_angles(legs)}"
            )
        case ZeroFault():
            return _zero(fault)
        case OrderFault():
            return _order(fault)


def _sign(legs: Sequence[int], columns: str) -> str:
    """Return a warning of legs whose angle probably has the other sign."""
    return (
        f"{WARNING}{_named(legs)} {_verb(legs, 'turn')} backwards and {_verb(legs, 'pass')} -90 "
        "deg, straight up, where slow as on the ground; expected 90 deg, straight down: sign = -1 "
        f"for {_angles(legs)} in [legs.columns] of {columns}, or in legs.sign of "
        "robot.toml, would repair both"
    )


def _zero(fault: ZeroFault) -> str:
    """Return a warning of legs whose angle probably has another zero, with offsets to mend it."""
    offsets = [0.0] * N_LEGS
    for leg, offset in zip(fault.legs, np.degrees(fault.offset), strict=True):
        offsets[leg - 1] = _rounded(float(offset))
    found = ", ".join(f"{angle:.0f}" for angle in np.degrees(fault.found))
    signs = ""
    if fault.reversed:
        signs = f"with sign = -1 for {_angles(fault.reversed)}, if they walk forward, "
    elif any(abs(offset) == 180 for offset in offsets):
        signs = "sign = -1, if they walk backwards, or "
    return (
        f"{WARNING}{_named(fault.legs)} {_verb(fault.legs, 'be')} slow, as on the ground, about "
        f"{found} deg; expected about 90 deg, straight down: {signs}offset_deg = "
        f"[{', '.join(f'{offset:g}' for offset in offsets)}] in [legs] of robot.toml would repair "
        "it, on top of what is there"
    )


def _rounded(offset: float) -> float:
    """Round an offset to a multiple of 90 deg if it is within `_CLOSE` of one, else of 5 deg.

    -180 becomes 180, which is the same angle, and -0 becomes 0.
    """
    quarter = 90.0 * round(offset / 90)
    rounded = quarter if abs(offset - quarter) <= _CLOSE else 5.0 * round(offset / 5)
    return 180.0 if rounded == -180 else rounded + 0.0


def _order(fault: OrderFault) -> str:
    """Return a warning of an order of legs in which no robot steps, with orders that are usual."""
    groups = " / ".join(", ".join(map(str, group)) for group in fault.groups)
    repairs = [_repair(order) for order in fault.orders[:_SHOWN_ORDERS]]
    return (
        f"{WARNING}legs step in the groups {groups}, as no walking robot's do; expected such as "
        f"1, 4, 5 / 2, 3, 6 (odd legs left, even legs right, 1 and 2 in front). Another order "
        f"would be consistent, for example {' or '.join(repairs)}"
    )


def _repair(order: Sequence[int]) -> str:
    """Describe an order of legs by the columns that would be those of legs 1 to 6.

    Args:
        order: Leg that each column `theta1` to `theta6` would then be.
    """
    columns = ", ".join(f"theta{order.index(leg) + 1}" for leg in range(1, N_LEGS + 1))
    told = f" ({ORDERS[tuple(order)]})" if tuple(order) in ORDERS else ""
    return f"legs 1 to 6 being what is now {columns}{told}"


def _backward(motion: LegMotion) -> tuple[str, ...]:
    """Return a note on which legs turn backwards; empty if none does."""
    backward = tuple(int(leg) + 1 for leg in np.nonzero(motion.direction < 0)[0])
    if not backward:
        return ()
    what = "a walk backwards" if len(backward) == N_LEGS else "a turn on the spot"
    return (f"leg log: {_named(backward)} {_verb(backward, 'turn')} backwards: {what}",)


def _named(legs: Sequence[int]) -> str:
    """Return legs as words: "leg 1", "legs 1 and 2"."""
    return f"leg{'s' * (len(legs) > 1)} {_listed(legs)}"


def _angles(legs: Sequence[int]) -> str:
    """Return the columns of legs as words: "theta1 and theta2"."""
    return _listed(f"theta{leg}" for leg in legs)


def _listed(items: Iterable[object]) -> str:
    """Join items by commas, and the last by "and"."""
    *others, last = map(str, items)
    return f"{', '.join(others)} and {last}" if others else last


def _verb(legs: Sequence[int], verb: str) -> str:
    """Return a verb in the singular or plural, by the number of legs."""
    if verb == "be":
        return "are" if len(legs) > 1 else "is"
    ending = "es" if verb.endswith("s") else "s"
    return verb if len(legs) > 1 else verb + ending
