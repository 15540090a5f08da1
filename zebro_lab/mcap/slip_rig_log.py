# SPDX-License-Identifier: MIT
"""Read samples of the slip rig in SI from the message of earlier versions.

New runs contain only raw samples (`raw_log`); logs with this message can still be read.
"""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Final

import numpy as np
from mcap.records import Schema
from numpy.typing import NDArray

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.cdr import CdrReader
from zebro_lab.mcap.log_records import Decode, read_log_messages

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


COLUMNS: Final = ("t", "omega_leg", "omega_ground", "normal_force", "traction_force")
"""Columns of the message, in its order."""


@dataclass(frozen=True)
class SlipRigTable:
    """Samples of one run of the slip rig, SI; each attribute has shape (n,).

    Attributes:
        t: Time since the start of the run [s].
        omega_leg: Angular speed of the leg disc [rad/s].
        omega_ground: Angular speed of the ground disc [rad/s].
        normal_force: Normal force, positive when pressed together [N].
        traction_force: Traction force, positive when driving [N].
        lateral_force: Force on the load cell's third axis, with its sign; None if not measured [N].
        angle_leg: Angle of the leg disc [rad]; None where none was recorded.
        angle_ground: Angle of the ground disc [rad]; None where none was recorded.
    """

    t: Array
    omega_leg: Array
    omega_ground: Array
    normal_force: Array
    traction_force: Array
    lateral_force: Array | None = None
    angle_leg: Array | None = None
    angle_ground: Array | None = None

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.t)

    def rows(self) -> Array:
        """Return the samples by rows with the columns `COLUMNS`, shape (n, 5)."""
        return np.column_stack([getattr(self, name) for name in COLUMNS])

    def measured(self) -> dict[str, Array]:
        """Return all that was measured, by its name."""
        every = {each.name: getattr(self, each.name) for each in fields(self)}
        return {name: values for name, values in every.items() if values is not None}

    def select(self, rows: NDArray[np.bool_]) -> "SlipRigTable":
        """Return some of the samples.

        Args:
            rows: Whether to keep each, shape (n,).
        """
        return SlipRigTable(**{name: values[rows] for name, values in self.measured().items()})


@dataclass(frozen=True)
class SalvagedLog:
    """Samples of the slip rig, read from a log that may be damaged.

    Attributes:
        table: Samples up to the damage.
        damage: Why reading stopped before the end; None for a log read to its end.
    """

    table: SlipRigTable
    damage: str | None


def decode_block(data: bytes) -> Array:
    """Decode a CDR message of the schema `SCHEMA_NAME` to rows of samples.

    Args:
        data: The message.

    Returns:
        Samples by rows with the columns `COLUMNS`, shape (m, 5).

    Raises:
        ValueError: The message is not CDR, truncated or empty, or sequences differ in length.
    """
    reader = CdrReader(data)
    columns = [reader.array("<f8") for _ in COLUMNS]
    if len({len(column) for column in columns}) > 1 or not len(columns[0]):
        raise ValueError("a message has columns of different lengths, or no samples")
    return np.column_stack(columns)


def read_log(path: Path) -> SalvagedLog:
    """Read the slip rig's samples from an MCAP log of an earlier version, up to the first damage.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is not regular, cannot be opened, is not MCAP, or no sample on `TOPIC`
            can be read.
    """
    blocks: list[NDArray[np.float64]] = []

    def decoder(schema: Schema, topic: str) -> Decode | None:
        if topic == TOPIC and schema.name != SCHEMA_NAME:
            raise ValueError(f"{TOPIC} is not of type {SCHEMA_NAME}")
        return decode_block if topic == TOPIC else None

    damage = read_log_messages(path, decoder, lambda *message: blocks.append(message[-1]))
    if not blocks:
        raise DataError(
            f"holds no readable samples of topic {TOPIC}" + (f" ({damage})" if damage else ""),
            file=path,
        )
    return SalvagedLog(SlipRigTable(*np.concatenate(blocks).T.copy()), damage)
