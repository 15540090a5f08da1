# SPDX-License-Identifier: MIT
"""Table of drivers and simulated twins by device and layout, imported when they are used."""

from dataclasses import dataclass
from importlib import import_module
from typing import Any, Final, Literal

from rig.profile import require_device


@dataclass(frozen=True)
class Backend:
    """Link of a layout, and classes that read and simulate it, as `module:Class`.

    Attributes:
        link: Link that the layout needs; `table` is not a device but an imported file.
        driver: Class of the driver, called with the link, `profile` and `clock`.
        twin: Class of the simulated device behind the same bytes.
    """

    link: Literal["serial", "can", "table"]
    driver: str = ""
    twin: str = ""


LEGS: Final = {
    "packet": Backend("serial", "rig.zebro.serial:PacketLegs", "rig.zebro.simulated:PacketRobot"),
    "dump": Backend("serial", "rig.zebro.serial:DumpLegs", "rig.zebro.simulated:DumpRobot"),
    "poll": Backend("serial", "rig.zebro.serial:PolledLegs", "rig.zebro.simulated:PolledRobot"),
    "can": Backend("can", "rig.zebro.can:CanLegs", "rig.zebro.simulated:CanRobot"),
    "table": Backend("table"),
}
"""Backend of each layout of a robot's legs."""
IMUS: Final = {
    "packet": Backend("serial", "rig.imu.stream:ImuStream", "rig.imu.simulated:SimulatedImu"),
    "table": Backend("table"),
}
"""Backend of each layout of an inertial measurement unit."""


def load_class(name: str, *, profile: str) -> Any:
    """Import a class of a `Backend`.

    Args:
        name: The class, as `module:Class`; empty for the layout `table`, which has none.
        profile: Name of the profile, for the message.

    Raises:
        ProfileError: The layout has no such class, since it describes a file.
    """
    require_device("device" if name else "table", profile)
    module, _, attribute = name.partition(":")
    return getattr(import_module(module), attribute)
