# SPDX-License-Identifier: MIT
"""Profile of a robot's leg stream: frame layout, and conversion of counts to leg angles."""

import struct
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias

import numpy as np
import tomlkit

from model.arrays import Array
from model.toml_table import TomlTable
from rig.device import Sample
from rig.driver_table import LEGS
from rig.errors import ProtocolError
from rig.profile import SCHEMA, open_profile
from rig.sample_columns import as_columns

Order: TypeAlias = Literal["little", "big"]
DUMP_REGISTERS: Final = 256
"""Number of one-byte registers of a robot."""


@dataclass(frozen=True)
class Registers:
    """Register map of a robot; each value takes two registers of one byte.

    Attributes:
        positions: First register of the position of each channel.
        read_command: Byte that requests registers.
        write_command: Byte that writes registers.
        set_points: First register of the set-point of each channel; empty for the layout `dump`,
            which takes no set-points.
        duration: First register of the duration of a motion, which is in milliseconds.
        stop: Register that stops every leg when a value other than 0 is written to it.
    """

    positions: tuple[int, ...] = ()
    read_command: int = 0xF0
    write_command: int = 0x0F
    set_points: tuple[int, ...] = ()
    duration: int = 0
    stop: int = 0


@dataclass(frozen=True)
class CanIds:
    """Arbitration ids of a robot on CAN.

    Attributes:
        clock: Id of the frame with the device time of the positions that follow.
        positions: Id of the frame with the leg positions.
        set_points: Id of the frame that commands targets of a motion.
        stop: Id of the frame that stops every leg.
    """

    clock: int = 0x120
    positions: int = 0x121
    set_points: int = 0x110
    stop: int = 0x100


@dataclass(frozen=True)
class LegProfile:
    r"""Profile of a robot's leg stream: frame layout and conversion of counts to leg angles.

    Leg angle of a count n, with the leg's zero n_0, sign s and N counts a revolution:

    .. math::
        \theta = s\,\frac{2\pi}{N}\,(n - n_0)

    Attributes:
        name: Name of the profile: that of its file without suffix.
        layout: Layout of the frames, a key of `rig.driver_table.LEGS`, which has its driver.
        baudrate: Line rate of the serial port, or bit rate of the bus; 0 for a table [1/s].
        byte_order: Byte order of values of two bytes.
        legs: Leg number of each channel, in the order of the wire.
        counts_per_revolution: Counts N of a whole turn; N itself reads as 0.
        zero_counts: Count n_0 of each channel with its toe straight ahead.
        sign: 1 for a channel whose count grows as the robot walks forward, else -1.
        rate: Sample rate [Hz].
        registers: Register map; used only in the layouts `dump` and `poll`.
        can_ids: Arbitration ids; used only in the layout `can`.
    """

    name: str
    layout: str
    baudrate: int
    byte_order: Order
    legs: tuple[int, ...]
    counts_per_revolution: int
    zero_counts: tuple[float, ...]
    sign: tuple[int, ...]
    rate: float
    registers: Registers = Registers()
    can_ids: CanIds = CanIds()

    @property
    def quantisation(self) -> float:
        """Half a count as an angle: an angle's error is uniform between minus and plus this [rad].

        0 for a table: its numbers have fractions, and their rounding is unknown.
        """
        return 0.0 if self.layout == "table" else float(np.pi / self.counts_per_revolution)

    def words(self, count: int) -> struct.Struct:
        """Return the layout of unsigned 16-bit values in the profile's byte order.

        Args:
            count: Number of values.
        """
        return struct.Struct(f"{'<' if self.byte_order == 'little' else '>'}{count}H")

    def possible(self, counts: tuple[float, ...]) -> bool:
        """Return whether every count is from 0 to `counts_per_revolution`, both included."""
        return max(counts) <= self.counts_per_revolution and min(counts) >= 0


@dataclass(frozen=True)
class LegAngles:
    """Leg angles of a stream.

    Attributes:
        host_time: Host time at which each sample was read, shape (n,) [s].
        device_time: Device time at which each sample was taken, NaN where unknown, shape (n,) [s].
        legs: Leg number of each column, ascending.
        theta: Unwrapped leg angles, shape (n, number of legs) [rad].
        quantisation: Half a count as an angle: the error of an angle is uniform between minus and
            plus this; 0 for a table [rad].
    """

    host_time: Array
    device_time: Array
    legs: tuple[int, ...]
    theta: Array
    quantisation: float


def load_leg_profile(name: str) -> LegProfile:
    """Read the profile of a leg stream.

    Args:
        name: Name of a shipped profile, or path of a TOML file.

    Returns:
        The profile.

    Raises:
        ProfileError: The file is missing or not such a profile; or a key is missing, unknown,
            invalid or contradicts another.
    """
    table = open_profile(name, device="legs")
    link, frame, legs, stream = (table.table(key) for key in ("link", "frame", "legs", "stream"))
    layout = frame.choice("layout", tuple(LEGS))
    kind, needed = link.text("kind"), LEGS[layout].link
    if kind != needed:
        raise link.fault(f"found '{kind}'; layout '{layout}' needs '{needed}'", "kind")
    order = _order(legs)
    registers = Registers()
    if layout in ("dump", "poll"):
        registers = _registers(frame, layout, len(order))
    elif len(order) != 6:
        raise legs.fault(f"found {len(order)} legs; layout '{layout}' needs all six", "order")
    profile = LegProfile(
        name=Path(name).stem,
        layout=layout,
        baudrate=0 if layout == "table" else link.whole("baudrate", least=1, most=20_000_000),
        byte_order="little"
        if layout in ("can", "table")
        else frame.choice("byte_order", ("little", "big")),
        legs=order,
        counts_per_revolution=legs.whole(
            "counts_per_revolution", least=2, most=100 if layout == "can" else 65_535
        ),
        zero_counts=_by_channel(legs.numbers("zero_counts", len(order)), order),
        sign=_by_channel(legs.signs("sign", len(order)), order),
        rate=stream.positive("rate"),
        registers=registers,
        can_ids=_can_ids(frame) if layout == "can" else CanIds(),
    )
    table.finish()
    return profile


def save_leg_profile(profile: LegProfile, path: Path) -> None:
    """Write a profile as TOML, so that `load_leg_profile` gives it back but for its name.

    Args:
        profile: The profile; its name is not stored: a loaded profile is named after its file.
        path: Path of the file; an existing file is overwritten.
    """
    path.write_text(render_leg_profile(profile), encoding="utf-8")


def render_leg_profile(profile: LegProfile) -> str:
    """Format a profile as the TOML that `load_leg_profile` reads; the name is not part of it."""
    return tomlkit.dumps(_as_document(profile))


def decode_angles(profile: LegProfile, samples: Sequence[Sample]) -> LegAngles:
    """Compute unwrapped leg angles from raw counts.

    A leg is taken to have turned the short way between two samples, so that after a gap in which
    it turned half a revolution or more its angle is wrong by whole turns, which does not change its
    contact with the ground.

    Args:
        profile: Profile of the stream; a corrected profile repairs an old log.
        samples: Samples of the stream, in order.

    Returns:
        Angles with their columns by ascending leg number; the first of each leg is in [-pi, pi].

    Raises:
        ProtocolError: The samples have another number of channels than the profile.
    """
    channels = len(profile.legs)
    columns = as_columns(samples)
    counts = columns.counts
    if len(samples) and counts.shape[1] != channels:
        raise ProtocolError(
            f"samples have {counts.shape[1]} channels; profile '{profile.name}' has {channels}"
        )
    turns = (counts.reshape(-1, channels) - profile.zero_counts) / profile.counts_per_revolution
    first = np.remainder(turns[:1] + 0.5, 1.0) - 0.5
    steps = np.remainder(np.diff(turns, axis=0) + 0.5, 1.0) - 0.5
    theta = 2 * np.pi * np.cumsum(np.vstack([first, steps]), axis=0) * profile.sign
    return LegAngles(
        host_time=columns.host_time,
        device_time=columns.device_time,
        legs=tuple(sorted(profile.legs)),
        theta=theta[:, np.argsort(profile.legs)],
        quantisation=profile.quantisation,
    )


def encode_counts(profile: LegProfile, theta: Sequence[float] | Array) -> tuple[int, ...]:
    """Compute the counts nearest to leg angles, in the order of the wire.

    Args:
        profile: Profile of the stream.
        theta: Leg angles by ascending leg number, shape (legs,) [rad].

    Returns:
        Count of each channel, from 0 to below a revolution.
    """
    ascending = sorted(profile.legs)
    by_channel = np.array([theta[ascending.index(leg)] for leg in profile.legs], dtype=float)
    turns = by_channel * profile.sign / (2 * np.pi)
    counts = np.rint(turns * profile.counts_per_revolution + profile.zero_counts)
    return tuple(int(c) for c in np.remainder(counts, profile.counts_per_revolution))


def _order(legs: TomlTable) -> tuple[int, ...]:
    """Read the leg number of each channel: all different, 1 to 6."""
    found = legs.wholes("order", least=1, most=6)
    if not found or len(set(found)) < len(found):
        raise legs.fault(f"found {list(found)}; expected different leg numbers, 1 to 6", "order")
    return found


def _by_channel(by_leg: tuple[Any, ...], order: tuple[int, ...]) -> tuple[Any, ...]:
    """Reorder values from ascending leg number to the order of the channels, `order`."""
    ascending = sorted(order)
    return tuple(by_leg[ascending.index(leg)] for leg in order)


def _registers(frame: TomlTable, layout: str, channels: int) -> Registers:
    """Read the register map; in `poll`, values of one read or one write must be adjacent."""
    last = DUMP_REGISTERS - 2  # a value takes two
    positions = frame.wholes("registers", most=last)
    if len(positions) != channels:
        raise frame.fault(f"found {len(positions)}; expected {channels}, one a leg", "registers")
    if layout == "dump":
        return Registers(positions)
    targets = frame.wholes("set_point_registers", most=last)
    for key, found in (("registers", positions), ("set_point_registers", targets)):
        expected = (
            [found[0] + 2 * leg for leg in range(channels)] if found else f"{channels} values"
        )
        if list(found) != expected:
            raise frame.fault(f"found {list(found)}; expected {expected}, in steps of two", key)
    duration = frame.whole("duration_register", most=last)
    if duration != targets[-1] + 2:
        raise frame.fault(
            f"found {duration}; expected {targets[-1] + 2}, the next after the set-points",
            "duration_register",
        )
    return Registers(
        positions,
        read_command=frame.whole("read_command", most=255),
        write_command=frame.whole("write_command", most=255),
        set_points=targets,
        duration=duration,
        stop=frame.whole("stop_register", most=DUMP_REGISTERS - 1),
    )


def _can_ids(frame: TomlTable) -> CanIds:
    """Read the four arbitration ids, of 11 bits and all different."""
    names = ("clock", "positions", "set_points", "stop")
    ids = {name: frame.whole(f"{name}_id", most=0x7FF) for name in names}
    if len(set(ids.values())) != len(ids):
        raise frame.fault(f"found {ids} as clock_id and so on; expected four different ids")
    return CanIds(**ids)


def _as_document(profile: LegProfile) -> dict[str, Any]:
    """Build the TOML document of a profile, with the values of the legs by ascending number."""
    ascending = sorted(profile.legs)
    channel_of = [profile.legs.index(leg) for leg in ascending]
    link: dict[str, Any] = {"kind": LEGS[profile.layout].link}
    if profile.layout != "table":
        link["baudrate"] = profile.baudrate
    frame: dict[str, Any] = {"layout": profile.layout}
    if profile.layout == "can":
        frame |= {f"{name}_id": value for name, value in asdict(profile.can_ids).items()}
    elif profile.layout != "table":
        frame["byte_order"] = profile.byte_order
    if profile.layout in ("dump", "poll"):
        frame["registers"] = list(profile.registers.positions)
    if profile.layout == "poll":
        frame |= {
            "read_command": profile.registers.read_command,
            "write_command": profile.registers.write_command,
            "set_point_registers": list(profile.registers.set_points),
            "duration_register": profile.registers.duration,
            "stop_register": profile.registers.stop,
        }
    return {
        "schema": SCHEMA,
        "device": "legs",
        "link": link,
        "frame": frame,
        "legs": {
            "order": list(profile.legs),
            "counts_per_revolution": profile.counts_per_revolution,
            "zero_counts": [profile.zero_counts[channel] for channel in channel_of],
            "sign": [profile.sign[channel] for channel in channel_of],
        },
        "stream": {"rate": profile.rate},
    }
