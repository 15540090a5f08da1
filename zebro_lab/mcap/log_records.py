# SPDX-License-Identifier: MIT
"""Read the messages of an MCAP log up to its first damage.

The seeking reader is not used: it needs the index at the end, which a truncated file has lost.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

from mcap.exceptions import InvalidMagic
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader

from zebro_lab.files.errors import DataError, ZebroLabError
from zebro_lab.files.opening import open_file

Decode: TypeAlias = Callable[[bytes], Any]


def read_log_messages(
    path: Path,
    decoder: Callable[[Schema, str], Decode | None],
    take: Callable[[str, int, str, Any], object],
) -> str | None:
    """Pass the messages of some types in an MCAP log to a function, up to the first damage.

    A missing end, a wrong checksum, an unknown compression and an exception of a decoder or of
    `take` count as damage.

    Args:
        path: The log.
        decoder: Returns what decodes the messages of a channel, given its schema and topic; None to
            skip them.
        take: Called with each message: topic, log time [ns], type and decoded content.

    Returns:
        Why reading stopped before the end, and in the message or description of what; None for a
        log read to its end.

    Raises:
        NotFound: The file does not exist.
        DataError: The file is not regular, cannot be opened, or does not begin (or, though it is
            complete, end) with the magic bytes of MCAP.
        ZebroLabError: `decoder` or `take` raised it.
    """
    schemas: dict[int, Schema] = {}
    decoders: dict[int, tuple[str, str, Decode]] = {}
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
                    decode = decoder(schema, record.topic)
                    if decode is not None:
                        decoders[record.id] = (record.topic, schema.name, decode)
                elif isinstance(record, Message) and record.channel_id in decoders:
                    topic, name, decode = decoders[record.channel_id]
                    where = f"a message of {topic}: "
                    take(topic, record.log_time, name, decode(record.data))
                where = ""
        except InvalidMagic as error:
            raise DataError("is not an MCAP file", file=path) from error
        except ZebroLabError:
            raise
        except Exception as error:  # libraries answer damage with whatever went wrong inside them
            return where + (str(error) or "the file ends early")  # EndOfFile has no words
    return None
