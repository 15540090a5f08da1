# SPDX-License-Identifier: MIT
"""Read the messages of an MCAP log up to its first damage.

The seeking reader is not used: it needs the index at the end, which a truncated file has lost.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from mcap.exceptions import InvalidMagic
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader

from zebro_lab.files.errors import DataError, ZebroLabError
from zebro_lab.files.opening import open_file

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
    """Read the messages of some types in an MCAP log, up to the first damage.

    A missing end, a wrong checksum, an unknown compression and an exception of a decoder count as
    damage.

    Args:
        path: The log.
        decoder: Returns what decodes the messages of a schema; None to skip them.

    Returns:
        The messages in the order of the log; and why reading stopped before the end, and in the
        message or description of what, None for a log read to its end.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is not regular, cannot be opened, or does not begin (or, though it is
            complete, end) with the magic bytes of MCAP.
        ZebroLabError: `decoder` raised it.
    """
    schemas: dict[int, Schema] = {}
    decoders: dict[int, tuple[str, str, Decode]] = {}
    messages: list[LoggedMessage] = []
    with open_file(path) as file:
        size = max(os.fstat(file.fileno()).st_size, 1)
        reader = StreamReader(file, validate_crcs=True, record_size_limit=size)
        where = ""
        try:
            for record in reader.records:
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel) and record.schema_id in schemas:
                    schema = schemas[record.schema_id]
                    where = f"the log's description of {schema.name}: "
                    decode = decoder(schema)
                    if decode is not None:
                        decoders[record.id] = (record.topic, schema.name, decode)
                elif isinstance(record, Message) and record.channel_id in decoders:
                    topic, name, decode = decoders[record.channel_id]
                    where = f"a message of {topic}: "
                    content = decode(record.data)
                    messages.append(LoggedMessage(topic, record.log_time, content, name))
                where = ""
        except InvalidMagic as error:
            raise DataError("is not an MCAP file", file=path) from error
        except ZebroLabError:
            raise
        except Exception as error:  # libraries answer damage with whatever went wrong inside them
            return messages, where + (str(error) or "the file ends early")  # EndOfFile has no words
    return messages, None
