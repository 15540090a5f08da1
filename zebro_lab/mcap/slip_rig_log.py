# SPDX-License-Identifier: MIT
"""The slip rig's samples as MCAP: blocks of samples as ROS 2 messages in CDR.

The messages are encoded here: the schema has only sequences of doubles, for which CDR is a
length and the numbers, and numpy writes and reads them 50 times faster than the general encoder
of mcap-ros2-support, against which the tests hold them.
"""

import struct
from dataclasses import dataclass, fields
from pathlib import Path
from typing import IO, TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from zebro_lab.files.errors import DataError
from zebro_lab.mcap.log_records import read_records

if TYPE_CHECKING:
    from mcap.records import McapRecord

TOPIC = "/slip_rig/samples"
SCHEMA_NAME = "zebro_lab/msg/SlipRigBlock"
SCHEMA_TEXT = """\
# Consecutive samples of the two-disc slip rig; all sequences are equally long.
float64[] t               # since the start of the run [s]
float64[] omega_leg       # angular speed of the leg disc [rad/s]
float64[] omega_ground    # angular speed of the ground disc [rad/s]
float64[] normal_force    # positive when pressed together [N]
float64[] traction_force  # positive when driving [N]
"""

_BLOCK = 64  # samples: 9 ms at the load cell's 7 kHz
_CHUNK_BYTES = 1 << 16  # what a file cut short can lose
_CDR_LITTLE_ENDIAN = b"\x00\x01\x00\x00"


@dataclass(frozen=True)
class SlipRigTable:
    """Samples of one run of the slip rig, SI, each shape (n,).

    Attributes:
        t: Time since the start of the run [s].
        omega_leg: Angular speed of the leg disc [rad/s].
        omega_ground: Angular speed of the ground disc [rad/s].
        normal_force: Normal force, positive when pressed together [N].
        traction_force: Traction force, positive when driving [N].
    """

    t: NDArray[np.float64]
    omega_leg: NDArray[np.float64]
    omega_ground: NDArray[np.float64]
    normal_force: NDArray[np.float64]
    traction_force: NDArray[np.float64]

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.t)

    def rows(self) -> NDArray[np.float64]:
        """Return the columns side by side, shape (n, 5), in the order of the attributes."""
        return np.column_stack([getattr(self, field.name) for field in fields(self)])


@dataclass(frozen=True)
class SalvagedLog:
    """What could be read of a log.

    Attributes:
        table: The samples.
        damage: Why reading stopped before the end; None for a whole log.
    """

    table: SlipRigTable
    damage: str | None


def encode_block(rows: NDArray[np.float64]) -> bytes:
    """Encode samples as one CDR message.

    Args:
        rows: Samples, shape (m, 5), m >= 1.
    """
    # Doubles are aligned to 8 bytes, counted from behind the 4 bytes of header.
    length = struct.pack("<I4x", len(rows))
    columns = np.ascontiguousarray(rows.T, dtype="<f8")
    return _CDR_LITTLE_ENDIAN + b"".join(length + column.tobytes() for column in columns)


def decode_block(data: bytes) -> NDArray[np.float64]:
    """Decode a CDR message of `encode_block`, shape (m, 5).

    Raises:
        ValueError: The message is not of that form.
    """
    if data[:4] != _CDR_LITTLE_ENDIAN or len(data) < 8:
        raise ValueError("a message is not little-endian CDR")
    (count,) = struct.unpack_from("<I", data, 4)
    width = len(fields(SlipRigTable))
    if count == 0 or len(data) != 4 + width * (8 + 8 * count):
        raise ValueError(f"a message of {len(data)} bytes does not hold {count} samples")
    words = np.frombuffer(data, dtype="<f8", offset=4).reshape(width, count + 1)
    return words[:, 1:].T


def write_log(file: IO[bytes], table: SlipRigTable, *, start_ns: int) -> None:
    """Write samples as MCAP, compressed with zstd.

    Args:
        file: Where to write.
        table: The samples.
        start_ns: Start of the run, since the Unix epoch [ns].
    """
    from mcap.well_known import MessageEncoding, SchemaEncoding
    from mcap.writer import CompressionType, Writer

    writer = Writer(file, chunk_size=_CHUNK_BYTES, compression=CompressionType.ZSTD)
    writer.start(profile="ros2", library="zebro-lab")
    schema = writer.register_schema(SCHEMA_NAME, SchemaEncoding.ROS2, SCHEMA_TEXT.encode())
    channel = writer.register_channel(TOPIC, MessageEncoding.CDR, schema)
    rows = table.rows()
    for sequence, first in enumerate(range(0, len(rows), _BLOCK)):
        block = rows[first : first + _BLOCK]
        stamp = start_ns + round(block[0, 0] * 1e9)
        writer.add_message(channel, stamp, encode_block(block), stamp, sequence)
    writer.finish()


def read_log(path: Path) -> SalvagedLog:
    """Read the samples of an MCAP log, up to the last whole chunk where it is damaged.

    Raises:
        DataError: The file is no MCAP, or not one sample of it can be read.
    """
    from mcap.records import Channel, Message, Schema

    blocks: list[NDArray[np.float64]] = []
    ours: set[int] = set()
    schemas: dict[int, str] = {}

    def take(record: "McapRecord") -> None:
        if isinstance(record, Schema):
            schemas[record.id] = record.name
        elif isinstance(record, Channel) and record.topic == TOPIC:
            if schemas.get(record.schema_id) != SCHEMA_NAME:
                raise ValueError(f"{TOPIC} is not of type {SCHEMA_NAME}")
            ours.add(record.id)
        elif isinstance(record, Message) and record.channel_id in ours:
            blocks.append(decode_block(record.data))

    damage = read_records(path, take)
    if not blocks:
        raise DataError(
            f"holds no samples on {TOPIC}" + (f" that can be read ({damage})" if damage else ""),
            file=path,
        )
    return SalvagedLog(SlipRigTable(*np.concatenate(blocks).T.copy()), damage)
