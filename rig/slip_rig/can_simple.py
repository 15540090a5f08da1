# SPDX-License-Identifier: MIT
"""Frame layouts of ODrive's CANSimple protocol for a velocity drive, little-endian.

The layouts are those of `odrive-cansimple.dbc`, which tools can read.
"""

import struct
from enum import IntEnum
from typing import Final

HEARTBEAT: Final = struct.Struct("<IB")
"""Axis error, axis state; firmwares differ in the three bytes after them."""
ESTIMATES: Final = struct.Struct("<ff")
"""Position [rev] and velocity [rev/s] of the motor."""
INPUT_VELOCITY: Final = struct.Struct("<ff")
"""Velocity [rev/s] and torque feed-forward [Nm]."""
AXIS_STATE: Final = struct.Struct("<I")
"""Requested axis state, an `AxisState`."""
CONTROLLER_MODE: Final = struct.Struct("<II")
"""Control mode and input mode."""
TEMPERATURES: Final = struct.Struct("<ff")
"""Temperature of the drive's transistors and of the motor [degC]; NaN or 0 without a sensor."""
VELOCITY_CONTROL: Final = 2
"""Control mode in which the drive follows a velocity."""
PASS_THROUGH: Final = 1
"""Input mode in which set-points are not filtered."""


class Command(IntEnum):
    """Command of a frame: low five bits of its arbitration id."""

    HEARTBEAT = 0x01
    EMERGENCY_STOP = 0x02
    SET_AXIS_STATE = 0x07
    ENCODER_ESTIMATES = 0x09
    SET_CONTROLLER_MODE = 0x0B
    SET_INPUT_VELOCITY = 0x0D
    TEMPERATURE = 0x15
    CLEAR_ERRORS = 0x18


class AxisState(IntEnum):
    """Axis states that this project requests."""

    IDLE = 1
    CLOSED_LOOP = 8


ERRORS: Final[dict[str, dict[int, str]]] = {
    "0.5": {
        0x1: "invalid state",
        0x40: "motor failed",
        0x80: "sensorless estimator failed",
        0x100: "encoder failed",
        0x200: "controller failed",
        0x800: "watchdog timer expired",
        0x4000: "emergency stop requested",
        0x40000: "over temperature",
    },
    "0.6": {
        0x1: "initializing",
        0x2: "system level",
        0x4: "timing error",
        0x8: "missing estimate",
        0x10: "bad configuration",
        0x20: "driver fault",
        0x40: "missing input",
        0x100: "DC bus over voltage",
        0x200: "DC bus under voltage",
        0x400: "DC bus over current",
        0x800: "DC bus over regeneration current",
        0x1000: "current limit violation",
        0x1000000: "watchdog timer expired",
    },
}
"""Meaning of the bits of an axis error, by firmware."""
WATCHDOG_EXPIRED: Final = {"0.5": 0x800, "0.6": 0x1000000}
"""Bit of the axis error that an expired watchdog sets, by firmware."""


def can_id(node: int, command: Command) -> int:
    """Compute the arbitration id: node in the upper six bits, command in the lower five.

    Args:
        node: Node of the axis, 0 to 63.
        command: Command of the protocol.

    >>> hex(can_id(3, Command.SET_INPUT_VELOCITY))
    '0x6d'
    """
    return node << 5 | command


def split_id(arbitration_id: int) -> tuple[int, int]:
    """Split an arbitration id into node and number of the command; the inverse of `can_id`."""
    return arbitration_id >> 5, arbitration_id & 0x1F


def describe_error(error: int, firmware: str) -> str:
    """Describe the set bits of an axis error as text, joined by commas; empty for 0.

    Args:
        error: Axis error, a field of bits.
        firmware: Version of the firmware, a key of `ERRORS`; another one is a KeyError.

    >>> describe_error(0x800, "0.5"), describe_error(0x10000000, "0.5")
    ('watchdog timer expired', 'unknown error 0x10000000')
    """
    names = [name for bit, name in ERRORS[firmware].items() if error & bit]
    rest = error & ~sum(ERRORS[firmware])
    return ", ".join(names + ([f"unknown error {rest:#x}"] if rest else []))
