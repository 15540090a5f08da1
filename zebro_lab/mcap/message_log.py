# SPDX-License-Identifier: MIT
"""Write an MCAP file of ROS 2 messages: channels by topic, schemas, sequence numbers."""

from collections.abc import Mapping
from typing import IO

from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import CompressionType, Writer

from zebro_lab.mcap.ros_messages import Schema


class MessageLog:
    """Writer of an MCAP file of ROS 2 messages by topic; not thread-safe.

    Args:
        file: Binary output file; the start of the MCAP file is written at once.
        chunk_size: Uncompressed size at which a chunk is compressed and written [bytes].

    Attributes:
        counts: Number of messages written, by topic; without topics that have none.
    """

    def __init__(self, file: IO[bytes], *, chunk_size: int = 1 << 20) -> None:
        self._writer = Writer(file, chunk_size=chunk_size, compression=CompressionType.ZSTD)
        self._writer.start(profile="ros2", library="zebro-lab")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self.counts: dict[str, int] = {}

    def register(
        self, topic: str, schema: Schema, *, metadata: Mapping[str, str] | None = None
    ) -> None:
        """Register a topic with its message type, so that `add` can write its messages.

        Args:
            topic: Name of the topic.
            schema: Message type; registered once for all topics with its name.
            metadata: Names and values stored with the topic's channel.
        """
        if schema.name not in self._schemas:
            self._schemas[schema.name] = self._writer.register_schema(
                schema.name, SchemaEncoding.ROS2, schema.text.encode()
            )
        self._channels[topic] = self._writer.register_channel(
            topic, MessageEncoding.CDR, self._schemas[schema.name], dict(metadata or {})
        )

    def add(self, topic: str, stamp: int, message: bytes) -> None:
        """Write a message with the topic's next sequence number, from 0.

        Args:
            topic: Name of a registered topic; KeyError for another.
            stamp: Log and publish time since the Unix epoch [ns].
            message: Message in CDR.
        """
        number = self.counts.get(topic, 0)
        self.counts[topic] = number + 1
        self._writer.add_message(self._channels[topic], stamp, message, stamp, number)

    def attach(self, stamp: int, name: str, media_type: str, content: str) -> None:
        """Write a text as an attachment of the file.

        Args:
            stamp: Time since the Unix epoch [ns].
            name: File name of the attachment.
            media_type: MIME type of the attachment.
            content: The text; stored in UTF-8.
        """
        self._writer.add_attachment(stamp, stamp, name, media_type, content.encode())

    def describe(self, name: str, content: Mapping[str, str]) -> None:
        """Write a metadata record of the whole file.

        Args:
            name: Name of the metadata record.
            content: Values by their names.
        """
        self._writer.add_metadata(name, dict(content))

    def flush(self) -> None:
        """Pass all buffered data to the operating system; they survive a crash of this process."""
        self._writer.flush()

    def finish(self) -> None:
        """Write the index and the end of the MCAP file; the file stays open."""
        self._writer.finish()
