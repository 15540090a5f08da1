# SPDX-License-Identifier: MIT
"""Read the messages of an MCAP log; of a damaged one those of every chunk that is whole."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from mcap.records import Channel, McapRecord, Message, Schema

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
    log = _Log(decoder)
    messages: list[LoggedMessage] = []
    with open_file(path) as file:
        records = SoundRecords(file)
        for record, is_sure in records:
            if not isinstance(record, Message):
                log.describe(record, is_sure=is_sure)
            elif (message := log.decode(record)) is not None:
                messages.append(message)
    if not records.is_mcap:
        raise DataError("is not an MCAP file", file=path)
    found = [*records.faults, *log.faults]
    if not found:
        return messages, None
    more = f", and {counted(len(found) - 1, 'further fault')}" if len(found) > 1 else ""
    return messages, f"{found[0]}{more}; {counted(records.skipped, 'byte')} left out"


class _Log:
    """Descriptions of a log's messages, and the decoders of those that are wanted.

    Args:
        decoder: As for `read_log_messages`.

    Attributes:
        faults: Why a message, or all of a channel, was not decoded.
    """

    def __init__(self, decoder: Callable[[Schema], Decode | None]) -> None:
        self.faults: list[str] = []
        self._decoder = decoder
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self._decoders: dict[int, Decode | None] = {}

    def describe(self, record: McapRecord, *, is_sure: bool) -> None:
        """Take a schema or channel; one that no checksum covers only where there is none yet."""
        if isinstance(record, Schema) and (is_sure or record.id not in self._schemas):
            self._schemas[record.id] = record
        if isinstance(record, Channel) and (is_sure or record.id not in self._channels):
            self._channels[record.id] = record

    def decode(self, record: Message) -> LoggedMessage | None:
        """Decode a message; None if it is not wanted, or has a fault, which is added to `faults`.

        Raises:
            ZebroLabError: The decoder of its schema raised it.
        """
        number, where = record.channel_id, "a message without its channel's description"
        try:
            channel = self._channels[number]
            if channel.schema_id == 0:
                return None
            schema = self._schemas[channel.schema_id]
            where = f"the log's description of {schema.name}"
            if number not in self._decoders:
                self._decoders[number] = None  # where that fails, the others are not tried either
                self._decoders[number] = self._decoder(schema)
            decode = self._decoders[number]
            if decode is None:
                return None
            where = f"a message of {channel.topic}"
            content = decode(record.data)
        except ZebroLabError:
            raise
        except Exception as error:  # libraries answer damage with whatever went wrong inside them
            self.faults.append(f"{where}: {error}")
            return None
        return LoggedMessage(channel.topic, record.log_time, content, schema.name)
