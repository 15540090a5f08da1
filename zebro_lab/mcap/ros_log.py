# SPDX-License-Identifier: MIT
"""Read messages of one type from a ROS 2 log, up to the first damage."""

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

from zebro_lab.mcap.log_records import read_records


class LoggedMessage(NamedTuple):
    """Decoded ROS 2 message of a log.

    Attributes:
        topic: Topic of the message.
        log_time: Time of logging since the Unix epoch [ns].
        content: The decoded message, an object with the message's fields as attributes.
    """

    topic: str
    log_time: int
    content: Any


def read_messages(path: Path, *, schema: str) -> tuple[list[LoggedMessage], str | None]:
    """Read all ROS 2 messages of one type from an MCAP log, up to the first damage.

    A message or a definition of the type that cannot be decoded counts as damage.

    Args:
        path: The log, in MCAP.
        schema: Name of the type, such as `sensor_msgs/msg/JointState`.

    Returns:
        The messages in the order of the log, and why reading stopped before the log's end; None
        for a log read to its end.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is not regular, cannot be opened, or is not MCAP.
    """
    from mcap.records import Channel, McapRecord, Message, Schema
    from mcap_ros2.decoder import DecoderFactory

    factory = DecoderFactory()
    schemas: dict[int, Schema] = {}
    decoders: dict[int, tuple[str, Any]] = {}
    messages: list[LoggedMessage] = []

    def take(record: McapRecord) -> None:
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            found = schemas.get(record.schema_id)
            if found is not None and found.name == schema:
                with _damage_of(f"the log's description of {schema}"):
                    decode = factory.decoder_for(record.message_encoding, found)
                if decode is not None:
                    decoders[record.id] = (record.topic, decode)
        elif isinstance(record, Message) and record.channel_id in decoders:
            topic, decode = decoders[record.channel_id]
            with _damage_of(f"a message of {topic}"):
                content = decode(record.data)
            messages.append(LoggedMessage(topic, record.log_time, content))

    damage = read_records(path, take)
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
