# SPDX-License-Identifier: MIT
"""Every parser of what devices and hosts send, with valid inputs for it."""

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import can
import numpy as np
from cobs import cobs

from benchmarks.faults.link_feeds import Answers, Datagrams, Feed, Frames, NoBus
from model.gait.reference import SampledReference
from rig.device import Limits, Sample
from rig.errors import RigError
from rig.imu.profile import load_imu_profile
from rig.imu.stream import ImuStream
from rig.links.can import CanLink
from rig.links.packet import Kind, Packet, encode_packet
from rig.links.slcan import SlcanAdapter, decode_frame, encode_frame
from rig.slip_rig.board import RigBoard, board_body, speed_body
from rig.slip_rig.can_simple import ESTIMATES, HEARTBEAT, Command, can_id
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.load_cell import RECORD, NetFtCell, Request, encode_request
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.can import CLOCK, POSITIONS, SET_POINTS, CanLegs
from rig.zebro.profile import LegProfile, load_leg_profile
from rig.zebro.serial import SYNC, DumpLegs, PacketLegs, PolledLegs
from rig.zebro.simulated import CanRobot, PacketRobot, PolledRobot
from rig.zebro.simulated_legs import SimulatedLegs
from zebro_lab.mcap.raw_log import decode_raw, encode_raw

LEGS = load_leg_profile("zebro-100-serial")
CAN_LEGS = load_leg_profile("zebro-100-can")
DUMP = load_leg_profile("vregs-dump")
POLL = load_leg_profile("zebrobus-uart")
IMU = load_imu_profile("imu-quaternion-serial")
RIG = load_rig_profile("rig-odrive-netft")
_BOARD_RIG = load_rig_profile("rig-board-serial")
assert _BOARD_RIG.board is not None
assert RIG.drives is not None
assert RIG.load_cell is not None
BOARD, DRIVES, CELL = _BOARD_RIG.board, RIG.drives, RIG.load_cell
LIMITS = Limits(speed=40.0, normal_force=30.0, traction_force=20.0)
GAIT = SampledReference(np.array([0.0, 1e6]), np.array([np.zeros(6), np.full(6, 1e6)]))

Take = Callable[[bytes], bool]
Make = Callable[[], Take]


@dataclass(frozen=True)
class Parser:
    """One parser.

    Attributes:
        make: Makes what takes one input and tells whether anything was accepted; made anew after
            a documented refusal by exception, as its owner would.
        valid: Valid inputs.
        refusals: What it may raise.
        has_memory: Whether it refuses what it took before; it is made anew for every 20 inputs.
        special: Inputs that are given to it first.
    """

    make: Make
    valid: list[bytes]
    refusals: tuple[type[Exception], ...] = ()
    has_memory: bool = False
    special: tuple[bytes, ...] = ()


def stream(driver: Any, profile: Any, link: type[Feed] = Feed, **more: Any) -> Make:
    """Make what feeds a byte stream's driver."""

    def make() -> Take:
        feed = link()
        device = driver(feed, profile=profile, clock=feed.clock, **more)

        def take(data: bytes) -> bool:
            feed.data = data
            return bool(device.read(0.02))

        return take

    return make


def polled() -> Take:
    """Make what feeds answers to a driver that asks for each reading."""
    feed = Answers()
    device = PolledLegs(feed, profile=POLL, clock=feed.clock)

    def take(data: bytes) -> bool:
        feed.clock.sleep(0.2)
        feed.waiting = data
        return bool(device.read(0.1))

    return take


def load_cell() -> Take:
    """Make what feeds a load cell's driver with datagrams."""
    feed: Any = Datagrams()
    cell = NetFtCell(feed, profile=CELL, clock=feed.clock)

    def take(data: bytes) -> bool:
        feed.data = [data]
        return bool(cell.read(0.0))

    return take


def frames(driver: Any, profile: Any, **more: Any) -> Make:
    """Make what feeds a driver on CAN; an input is an id and up to eight bytes."""

    def make() -> Take:
        feed = Frames()
        device = driver(feed, profile=profile, clock=feed.clock, **more)

        def take(data: bytes) -> bool:
            feed.data = [frame_of(data)]
            return bool(device.read(0.0))

        return take

    return make


def frame_of(data: bytes) -> can.Message:
    """Read an input as a frame: two bytes of id, then the data."""
    number = int.from_bytes(data[:2], "big") & 0x7FF
    return can.Message(arbitration_id=number, data=data[2:10], is_extended_id=False)


def frame_bytes(number: int, data: bytes) -> bytes:
    """Write a frame as an input."""
    return number.to_bytes(2, "big") + data


def twin(robot: Any, profile: LegProfile) -> Make:
    """Make what feeds a robot's twin with what a host may send; any answer is an acceptance."""

    def make() -> Take:
        rng = np.random.default_rng(0)
        device = robot(SimulatedLegs(GAIT, profile=profile), rng=rng)
        return lambda data: bool(device.poll(0.0, data))

    return make


def can_twin() -> Take:
    """Make what feeds a robot's twin on CAN; a stop or set-points are an acceptance."""
    rng = np.random.default_rng(0)
    bus: Any = NoBus()
    robot = CanRobot(SimulatedLegs(GAIT, profile=CAN_LEGS), bus, rng=rng)

    def take(data: bytes) -> bool:
        message = frame_of(data)
        bus.waiting = [message]
        robot.poll(0.0)
        ids = CAN_LEGS.can_ids
        return message.arbitration_id in (ids.stop, ids.set_points)

    return take


def adapter() -> Take:
    """Make what feeds the adapter of SLCAN."""
    bus: Any = NoBus()
    device = SlcanAdapter(bus, source="sim:fuzz")
    device.poll(0.0, b"O\r")

    def take(data: bytes) -> bool:
        before = device.refused
        device.poll(0.0, data)
        return device.refused == before

    return take


def slcan_host() -> Take:
    """Make what feeds python-can's own slcan interface, under the link that guards it."""
    from can.interfaces.slcan import slcanBus

    bus = slcanBus("loop://", sleep_after_open=0.0, timeout=0)
    link = CanLink(bus)
    link.open()

    def take(data: bytes) -> bool:
        bus.serialPortOrig.write(data[:60])
        return bool(link.read(0.0))

    return take


def whole(function: Callable[[bytes], object]) -> Make:
    """Make what calls a function that returns or raises."""

    def take(data: bytes) -> bool:
        function(data)
        return True

    return lambda: take


def packets(kind: Kind, body: struct.Struct, values: Sequence[Sequence[int]]) -> list[bytes]:
    """Encode a packet for each row of values."""
    return [encode_packet(Packet(kind, n, 10_000 * n, body.pack(*v))) for n, v in enumerate(values)]


def samples(count: int, width: int) -> list[Sample]:
    """Return samples of consecutive counts."""
    return [Sample(0.01 * n, 0.01 * n, n, tuple(range(n, n + width))) for n in range(count)]


def leg_counts() -> list[list[int]]:
    """Draw counts of six legs, 40 rows."""
    return np.random.default_rng(1).integers(0, 100, (40, 6)).tolist()


def dumps() -> list[bytes]:
    """Make dumps of a leg's registers, each with another position."""
    made = []
    for count in np.random.default_rng(1).integers(0, 910, 40).tolist():
        registers = bytearray(256)
        registers[110:112] = count.to_bytes(2, "big")
        made.append(bytes(registers) + SYNC)
    return made


def leg_frames() -> list[bytes]:
    """Return valid frames of legs on CAN."""
    ids, legs = CAN_LEGS.can_ids, leg_counts()
    return [
        *(frame_bytes(ids.clock, CLOCK.pack(n, n)) for n in range(20)),
        *(frame_bytes(ids.positions, POSITIONS.pack(*legs[n], n)) for n in range(20)),
        frame_bytes(ids.set_points, SET_POINTS.pack(*legs[0], 100)),
        frame_bytes(ids.stop, b""),
    ]


def drive_frames() -> list[bytes]:
    """Return valid frames of both drives."""
    heartbeat, estimates = HEARTBEAT.pack(0, 8) + bytes(3), ESTIMATES.pack(1.5, 2.5)
    return [
        frame_bytes(can_id(node, command), data)
        for node in (DRIVES.leg.node, DRIVES.ground.node)
        for command, data in (
            (Command.HEARTBEAT, heartbeat),
            (Command.ENCODER_ESTIMATES, estimates),
        )
    ]


def of_streams() -> dict[str, Parser]:
    """Return the parsers of what devices send by serial lines and UDP, by name."""
    rng = np.random.default_rng(1)
    quaternions = [(16384, 0, 0, 0, *row) for row in rng.integers(-999, 999, (40, 6)).tolist()]
    forces = [(*row, 0) for row in rng.integers(-999_999, 999_999, (40, 4)).tolist()]
    legs = packets(Kind.LEGS, LEGS.words(6), leg_counts())
    imu = packets(Kind.ORIENTATION, IMU.body, quaternions)
    board = packets(Kind.SLIP_RIG, board_body(BOARD), forces)
    answers = [struct.pack(">6H", *row) for row in rng.integers(0, 910, (40, 6)).tolist()]
    records = [RECORD.pack(n, n, 0, *range(n, n + 6)) for n in range(40)]
    rig_board = stream(RigBoard, BOARD, limits=LIMITS)
    return {
        "leg packets": Parser(stream(PacketLegs, LEGS), legs, (RigError,), has_memory=True),
        "IMU packets": Parser(stream(ImuStream, IMU), imu, (RigError,), has_memory=True),
        "rig board packets": Parser(rig_board, board, (RigError,), has_memory=True),
        "COBS alone": Parser(
            whole(cobs.decode), [cobs.encode(each) for each in raw_messages()], (cobs.DecodeError,)
        ),
        "register dumps": Parser(stream(DumpLegs, DUMP), dumps()),
        "ZebroBus answers": Parser(polled, answers),
        "RDT records": Parser(load_cell, records, has_memory=True),
    }


def on_can() -> dict[str, Parser]:
    """Return the parsers of frames on CAN and of SLCAN, by name."""
    lines = [encode_frame(frame_of(frame)) for frame in leg_frames() + drive_frames()]
    drives = frames(DriveBus, DRIVES, limits=LIMITS)
    line = whole(lambda data: decode_frame(data.rstrip(b"\r")))
    return {
        "CANSimple frames": Parser(drives, drive_frames()),
        "leg frames on CAN": Parser(frames(CanLegs, CAN_LEGS), leg_frames(), has_memory=True),
        "SLCAN lines": Parser(line, lines, (RigError,)),
        "SLCAN lines, at the adapter": Parser(adapter, lines),
        "SLCAN lines, python-can's host": Parser(slcan_host, lines),
    }


def at_twins() -> dict[str, Parser]:
    """Return the parsers of what hosts send to simulated devices, by name."""
    commands = [
        encode_packet(Packet(Kind.LEG_SET_POINTS, 0, 0, struct.pack("<7H", *range(6), 100))),
        encode_packet(Packet(Kind.STOP, 1, 0, b"")),
        encode_packet(Packet(Kind.DISC_SPEEDS, 2, 0, speed_body(BOARD).pack(1, 2))),
    ]
    requests = [b"\xf0\x20\x0c", b"\x0f\x3e\x01\x01",
                b"\x0f\x30\x0e" + struct.pack(">7H", *range(6), 100)]  # fmt: skip
    return {
        "RDT requests, at the twin": Parser(
            whole(lambda data: struct.unpack(">HHI", data[:8].ljust(8, b"\0"))),
            [encode_request(request) for request in Request],
        ),
        "commands to the twin, packets": Parser(twin(PacketRobot, LEGS), commands, has_memory=True),
        "commands to the twin, registers": Parser(twin(PolledRobot, POLL), requests),
        "commands to the twin, CAN": Parser(can_twin, leg_frames()),
    }


def of_messages() -> dict[str, Parser]:
    """Return the parsers of a log's messages; of whole files see `file_readers`."""
    return {
        "raw messages": Parser(
            whole(lambda data: decode_raw(data, dtype="<i4")), raw_messages(), (ValueError,)
        ),
    }


def raw_messages() -> list[bytes]:
    """Return valid messages of raw samples."""
    return [encode_raw(samples(n + 1, 6), dtype="<i4", start=0.0) for n in range(20)]


def parsers() -> dict[str, Parser]:
    """Return every parser by name."""
    return of_streams() | on_can() | at_twins() | of_messages()
