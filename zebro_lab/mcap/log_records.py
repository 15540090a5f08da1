# SPDX-License-Identifier: MIT
"""Read the messages of an MCAP log; of a damaged one those of every chunk that is whole."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from mcap.records import Channel, Message, Schema

from model.counted import counted
from zebro_lab.files.errors import DataError, ZebroLabError
from zebro_lab.files.opening import open_file
from zebro_lab.mcap.sound_records import SoundRecords

Decode: TypeAlias = Callable[[bytes], Any]


class LoggedMessage(NamedTuple):
    """Decoded message of a log.

    Attributes:
        topic: Topic of the message.
        log_time: Time of logging since the Unix epoch [ns].
        content: The decoded message; of ROS an object with the message's fields as attributes.
        type: Name of its type, such as `sensor_msgs/msg/JointState`.
    """

    topic: str
    log_time: int
    content: Any
    type: str = ""


def read_log_messages(
    path: Path, decoder: Callable[[Schema], Decode | None]
) -> tuple[list[LoggedMessage], str | None]:
    """Read the messages of some types in an MCAP log, without those in damaged bytes.

    A missing end, a wrong checksum, an unknown compression and an exception of a decoder count as
    damage.

    Args:
        path: The log.
        decoder: Returns what decodes the messages of a schema; None to skip them.

    Returns:
        The messages in the order of the log; and what is damaged, where, and how many bytes or
        messages are left out for it, None for a log without damage.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is not regular, cannot be opened, or has neither the magic bytes of MCAP
            nor a whole chunk.
        ZebroLabError: `decoder` raised it.
    """
    known: dict[tuple[type, int], Any] = {}
    decoders: dict[int, Decode | None] = {}
    messages: list[LoggedMessage] = []
    with open_file(path) as file:
        records = SoundRecords(file)
        for record, is_sure in records:
            if not isinstance(record, Message):
                key = type(record), record.id
                known[key] = record if is_sure else known.get(key, record)
                continue
            number, where = record.channel_id, "a message that the log does not describe"
            try:
                channel = known[Channel, number]
                schema: Any = known[Schema, channel.schema_id] if channel.schema_id else None
                if number not in decoders:
                    where = f"the log's description of {channel.topic}"
                    decoders[number] = None  # where it fails, it does so once
                    decoders[number] = schema and decoder(schema)
                if (decode := decoders[number]) is not None:
                    where = f"a message of {channel.topic}"
                    content = decode(record.data)
                    found = LoggedMessage(channel.topic, record.log_time, content, schema.name)
                    messages.append(found)
            except ZebroLabError:
                raise
            except Exception as error:  # decoders answer damage with whatever went wrong inside
                records.faults.append(f"{where}: {error}")
    if not records.is_mcap:
        raise DataError("is not an MCAP file", file=path)
    if not (faults := records.faults):
        return messages, None
    count = f"{counted(len(faults), 'fault')}, {counted(records.skipped, 'byte')} left out"
    return messages, f"{faults[0]}; {count}"
