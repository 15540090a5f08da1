# SPDX-License-Identifier: MIT
"""Read messages of some types from a ROS log, up to the first damage."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

from mcap.records import Schema
from mcap.well_known import MessageEncoding
from mcap_ros2.decoder import DecoderFactory

from zebro_lab.mcap.log_records import Decode, read_log_messages
from zebro_lab.mcap.ros_bags import LoggedMessage, is_bag, read_bag


def read_messages(path: Path, *, schema: str) -> tuple[list[LoggedMessage], str | None]:
    """Read all messages of one type from a ROS log; see `read_typed_messages`."""
    return read_typed_messages(path, (schema,))


def read_typed_messages(
    path: Path, types: Collection[str]
) -> tuple[list[LoggedMessage], str | None]:
    """Read all messages of some types from a ROS log, up to the first damage.

    A message or a definition of a type that cannot be decoded counts as damage.

    Args:
        path: The log: MCAP of ROS 2, or a bag.
        types: Names of the types, such as `sensor_msgs/msg/JointState`.

    Returns:
        The messages in the order of the log, and why reading stopped before the log's end; None
        for a log read to its end.

    Raises:
        NotFound: The file does not exist, or the package `rosbags` for a bag.
        DataError: The file is not regular, cannot be opened, or is not MCAP or a bag.
    """
    if path.is_dir() and (parts := sorted(path.glob("*.mcap"))):
        read = [_read_mcap(part, types) for part in parts]
        messages = sorted((m for found, _ in read for m in found), key=lambda m: m.log_time)
        return messages, next((damage for _, damage in read if damage is not None), None)
    return read_bag(path, types) if is_bag(path) else _read_mcap(path, types)


def _read_mcap(path: Path, types: Collection[str]) -> tuple[list[LoggedMessage], str | None]:
    factory = DecoderFactory()
    messages: list[LoggedMessage] = []

    def decoder(schema: Schema, topic: str) -> Decode | None:
        if schema.name not in types:
            return None
        with _damage_of(f"the log's description of {schema.name}"):
            decode = factory.decoder_for(MessageEncoding.CDR, schema)

        def decode_message(data: bytes) -> Any:
            with _damage_of(f"a message of {topic}"):
                return None if decode is None else decode(data)

        return None if decode is None else decode_message

    def take(topic: str, log_time: int, name: str, content: Any) -> None:
        messages.append(LoggedMessage(topic, log_time, content, name))

    damage = read_log_messages(path, decoder, take)
    return messages, damage


@contextmanager
def _damage_of(what: str) -> Iterator[None]:
    """Convert any exception of the ROS 2 decoder in the body to a `ValueError`; mute its prints.

    Raises:
        ValueError: The decoder failed; the message begins with `what`.
    """
    try:
        with redirect_stdout(StringIO()):  # it prints what it does not understand
            yield
    except Exception as error:
        raise ValueError(f"{what} cannot be read: {type(error).__name__}: {error}") from error
