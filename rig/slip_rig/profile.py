# SPDX-License-Identifier: MIT
"""Profile of a slip rig: discs, limits, drives, load cell or board."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal, TypeAlias

from model.toml_table import TomlTable
from rig.device import Limits
from rig.errors import ProfileError
from rig.profile import open_profile, require_device

BoardLink: TypeAlias = Literal["serial", "table"]
AXES: Final = ("x", "y", "z")
HIGHEST_NODE: Final = 0x3F
"""Highest node of CANSimple: six bits."""
FURTHER_LIMITS: Final = {"lateral_force": "N", "torque": "N m", "temperature_celsius": "degC"}
"""Optional limits of a rig, and their units."""
_NO_LIMITS: Final = Limits(speed=math.inf, normal_force=math.inf, traction_force=math.inf)


@dataclass(frozen=True)
class DiscDrive:
    """One ODrive axis and the disc it turns.

    Attributes:
        node: CAN node of the axis, 0 to 63.
        gear: Turns of the motor per turn of the disc [-].
        sign: 1 if a positive speed of the motor turns the disc in the driving direction, else -1.
    """

    node: int
    gear: float
    sign: int


@dataclass(frozen=True)
class DriveProfile:
    """Both drives of a rig.

    Attributes:
        bitrate: Bit rate of the CAN bus [bit/s].
        firmware: Version of both drives' firmware, which defines the error bits.
        feed_interval: Interval between two set-points, which feed the drives' watchdogs [s].
        leg: Drive of the leg disc.
        ground: Drive of the ground disc.
    """

    bitrate: int
    firmware: Literal["0.5", "0.6"]
    feed_interval: float
    leg: DiscDrive
    ground: DiscDrive


@dataclass(frozen=True)
class ForceAxis:
    """Channel of a load cell, Fx, Fy or Fz, that measures a force, and its sign.

    Attributes:
        index: Channel: 0 for Fx, 1 for Fy, 2 for Fz.
        sign: Factor that makes the force positive as defined in `docs/conventions.md`, 1 or -1.
    """

    index: int
    sign: int


@dataclass(frozen=True)
class LoadCellProfile:
    """A Net F/T load cell.

    Attributes:
        host: Network name or address of the cell.
        port: UDP port of the cell.
        rate: Records per second, and readings per second in the cell's own numbering [Hz].
        counts_per_force: Counts per newton [1/N].
        counts_per_torque: Counts per newton metre; None where torques are not evaluated [1/(N m)].
        normal: Channel and sign of the normal force.
        traction: Channel and sign of the traction force.
    """

    host: str
    port: int
    rate: float
    counts_per_force: float
    counts_per_torque: float | None
    normal: ForceAxis
    traction: ForceAxis


@dataclass(frozen=True)
class BoardProfile:
    """One micro-controller instead of drives and load cell, or a table of their measurements.

    Attributes:
        baudrate: Line rate; 0 for a table [baud].
        rate: Sample rate [Hz].
        byte_order: Byte order of counts and status.
        feed_interval: Interval between two speed commands, which feed the board's watchdog; 0 for a
            table [s].
        counts_per_force: Counts per newton [1/N].
        counts_per_speed: Counts per angular speed of a disc [s/rad].
        normal_sign: Factor that makes the normal force positive when pressed together, 1 or -1.
        traction_sign: Factor that makes the traction force positive when driving, 1 or -1.
        link: `serial`, or `table` for an imported file.
    """

    baudrate: int
    rate: float
    byte_order: Literal["little", "big"]
    feed_interval: float
    counts_per_force: float
    counts_per_speed: float
    normal_sign: int
    traction_sign: int
    link: BoardLink = "serial"


@dataclass(frozen=True)
class Zero:
    """Zero offset: mean reading of an unloaded load cell.

    Attributes:
        normal: Mean normal force [N].
        traction: Mean traction force [N].
        standard_error: Larger of the standard errors of both means [N].
    """

    normal: float
    traction: float
    standard_error: float


@dataclass(frozen=True)
class RigProfile:
    """A slip rig: either drives and a load cell, or a board.

    Attributes:
        name: Name of the profile: that of its file without suffix.
        radius_leg: Radius of the leg disc [m].
        radius_ground: Radius of the ground disc [m].
        limits: Largest magnitudes allowed; infinite where the board is a table.
        drives: Both drives; None where there is a board.
        load_cell: The load cell; None where there is a board.
        board: The board; None where there are drives.
        unloaded: What the load cell or board reads without load; None where that is not known.
    """

    name: str
    radius_leg: float
    radius_ground: float
    limits: Limits
    drives: DriveProfile | None
    load_cell: LoadCellProfile | None
    board: BoardProfile | None
    unloaded: Zero | None = None

    @property
    def measured(self) -> frozenset[str]:
        """Names of those of `FURTHER_LIMITS` whose quantity a device of the rig measures.

        A load cell measures `lateral_force` and, with a scale of torques, `torque`; drives measure
        `temperature_celsius`; a board none.
        """
        measures = {
            "lateral_force": self.load_cell is not None,
            "torque": self.load_cell is not None and self.load_cell.counts_per_torque is not None,
            "temperature_celsius": self.drives is not None,
        }
        return frozenset(key for key, known in measures.items() if known)


def device_profiles(profile: RigProfile) -> BoardProfile | tuple[DriveProfile, LoadCellProfile]:
    """Return the profile of a rig's board, or those of its drives and its load cell.

    Raises:
        ProfileError: The profile describes a table, or has neither a board nor both drives and
            load cell.
    """
    if profile.board is not None:
        require_device(profile.board.link, profile.name)
        return profile.board
    if profile.drives is None or profile.load_cell is None:
        raise ProfileError(f"profile '{profile.name}' has neither a board nor drives and load cell")
    return profile.drives, profile.load_cell


def load_rig_profile(name: str) -> RigProfile:
    """Read the profile of a slip rig.

    Args:
        name: Name of a shipped profile, or path of a TOML file.

    Returns:
        The profile.

    Raises:
        ProfileError: The file is missing or not such a profile; or a key is missing, unknown,
            invalid or contradicts another.
    """
    table = open_profile(name, device="slip-rig")
    discs, limits, unloaded = (table.table(key) for key in ("discs", "limits", "unloaded"))
    drives, load_cell, board = (table.table(key) for key in ("drives", "load_cell", "board"))
    if not drives.empty == load_cell.empty != board.empty:  # both or neither, and else the board
        raise table.fault("expected either [drives] and [load_cell], or [board], not both")
    profile = RigProfile(
        name=Path(name).stem,
        radius_leg=discs.positive("radius_leg"),
        radius_ground=discs.positive("radius_ground"),
        drives=None if drives.empty else _drives(drives),
        load_cell=None if load_cell.empty else _load_cell(load_cell),
        board=(made := None if board.empty else _board(board)),
        unloaded=None
        if unloaded.empty
        else Zero(*(unloaded.number(key) for key in ("normal", "traction", "standard_error"))),
        limits=_NO_LIMITS if made and made.link == "table" else _limits(limits),
    )
    table.finish()
    for key in FURTHER_LIMITS:
        if getattr(profile.limits, key) is not None and key not in profile.measured:
            raise limits.fault("no device of this rig measures this; remove the limit", key)
    return profile


def _limits(table: TomlTable) -> Limits:
    """Read the rig's limits; those of `FURTHER_LIMITS` are optional."""
    return Limits(
        speed=table.positive("speed"),
        normal_force=table.positive("normal_force"),
        traction_force=table.positive("traction_force"),
        **{key: table.positive_or_none(key) for key in FURTHER_LIMITS},
    )


def _drives(table: TomlTable) -> DriveProfile:
    """Read both drives, whose nodes must differ."""
    leg, ground = (_disc_drive(table.table(key)) for key in ("leg", "ground"))
    if leg.node == ground.node:
        raise table.fault(f"both drives have node {leg.node}; expected two different nodes")
    return DriveProfile(
        bitrate=table.whole("baudrate", least=1, most=8_000_000),
        firmware=table.choice("firmware", ("0.5", "0.6")),
        feed_interval=table.positive("feed_interval"),
        leg=leg,
        ground=ground,
    )


def _disc_drive(table: TomlTable) -> DiscDrive:
    """Read node, gear and sign of one drive."""
    return DiscDrive(
        node=table.whole("node", most=HIGHEST_NODE),
        gear=table.positive("gear"),
        sign=table.sign("sign"),
    )


def _load_cell(table: TomlTable) -> LoadCellProfile:
    """Read the load cell; normal and traction force must be on different axes."""
    normal, traction = (_axis(table.table(key)) for key in ("normal", "traction"))
    if normal.index == traction.index:
        raise table.fault(
            f"found '{AXES[normal.index]}', which is {table.dotted('normal.axis')}, too; expected "
            "another axis for the traction force",
            "traction.axis",
        )
    return LoadCellProfile(
        host=table.text("host"),
        port=table.whole("port", 49_152, least=1, most=65_535),
        rate=table.positive("rate"),
        counts_per_force=table.positive("counts_per_force"),
        counts_per_torque=table.positive_or_none("counts_per_torque"),
        normal=normal,
        traction=traction,
    )


def _axis(table: TomlTable) -> ForceAxis:
    """Read the channel x, y or z of a force, and its sign."""
    return ForceAxis(AXES.index(table.choice("axis", AXES)), table.sign("sign"))


def _board(table: TomlTable) -> BoardProfile:
    """Read the board; one that is a table has no line, byte order or watchdog."""
    link: BoardLink = table.choice("link", ("serial", "table"), "serial")
    is_table = link == "table"
    return BoardProfile(
        link=link,
        baudrate=0 if is_table else table.whole("baudrate", least=1, most=20_000_000),
        rate=table.positive("rate"),
        byte_order="little" if is_table else table.choice("byte_order", ("little", "big")),
        feed_interval=0.0 if is_table else table.positive("feed_interval"),
        counts_per_force=table.positive("counts_per_force"),
        counts_per_speed=table.positive("counts_per_speed"),
        normal_sign=table.sign("normal_sign"),
        traction_sign=table.sign("traction_sign"),
    )
