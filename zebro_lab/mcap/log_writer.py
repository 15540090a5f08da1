# SPDX-License-Identifier: MIT
"""Write the MCAP log of a run incrementally, so that it is readable up to the last flush."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import fields
from io import BytesIO
from typing import IO, Final

from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import CompressionType, IndexType, Writer

from rig.device import Counters, Sample
from rig.sample_columns import as_columns
from zebro_lab.mcap.cdr import CdrWriter
from zebro_lab.mcap.raw_log import RAW_SCHEMAS, RawStream, encode_raw, raw_topic

EVENTS: Final = "/events"
LOG: Final = "rcl_interfaces/msg/Log"
"""Type of the messages of `EVENTS`."""
LOG_TEXT: Final = f"""\
builtin_interfaces/Time stamp
uint8 level
string name
string msg
string file
string function
uint32 line
{"=" * 80}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
INFO, WARNING, ERROR = 20, 30, 40
"""Severity levels of a `LOG` message, by ROS."""
_COUNTERS: Final = "zebro_lab/msg/Counters"
_SCHEMAS: Final = {
    **{name: text for name, (_, text) in RAW_SCHEMAS.items()},
    LOG: LOG_TEXT,
    _COUNTERS: "# What happened to a stream so far.\n"
    + "".join(f"uint64 {field.name}\n" for field in fields(Counters))
    + "uint64 dropped  # by the recorder: nobody wrote them in time\n",
}
"""Definition in ros2msg of each type of message."""
_CHUNK_BYTES: Final = 1 << 20  # flushing ends a chunk long before

_KEPT: Final = "_Writer__chunk_indices"
"""Where the library keeps its entry of each chunk until the end, also those it is not to write."""


class LogWriter:
    """Writer of a run's MCAP log: raw samples, counters, events; not thread-safe.

    Args:
        file: Binary output file; writing to it begins at once.
        streams: Description of each stream's raw samples, by the stream's name.
        attachments: Texts of the device profiles to attach, by file name.
        start: Host time at which the run began [s].
        start_ns: Start of the run since the Unix epoch [ns].

    Attributes:
        written: Number of samples written, by topic of the raw samples.
    """

    def __init__(
        self,
        file: IO[bytes],
        *,
        streams: Mapping[str, RawStream],
        attachments: Mapping[str, str],
        start: float,
        start_ns: int,
    ) -> None:
        self.written = {raw_topic(name): 0 for name in streams}
        self._start, self._start_ns = start, start_ns
        self._dtypes = {name: RAW_SCHEMAS[each.schema][0] for name, each in streams.items()}
        # Without an index of the chunks, ten a second, which would be kept until the end.
        self._writer = Writer(
            file, chunk_size=_CHUNK_BYTES, compression=CompressionType.ZSTD,
            index_types=IndexType.ATTACHMENT,
        )  # fmt: skip
        self._writer.start(profile="ros2", library="zebro-lab")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._messages: Counter[str] = Counter()
        self._latest = 0
        # Descriptions stand in the first chunk, at the end, and here, should that chunk be damaged.
        copies = BytesIO()
        self._writers = (Writer(copies, use_chunking=False), self._writer)
        self._register(EVENTS, LOG)
        for name, stream in streams.items():
            self._register(raw_topic(name), stream.schema, stream.metadata)
            self._register(f"/{name}/counters", _COUNTERS)
        self._writers[0].flush()
        file.write(copies.getvalue())
        for name, text in attachments.items():
            self._writer.add_attachment(start_ns, start_ns, name, "application/toml", text.encode())

    def write(self, stream: str, samples: Sequence[Sample]) -> None:
        """Write samples of a stream as one message, stamped with the time of the last sample.

        Args:
            stream: Name of the stream, one of `streams`.
            samples: Next samples of the stream, at least one.
        """
        dtype, topic = self._dtypes[stream], raw_topic(stream)
        columns = as_columns(samples, dtype)
        stamp = self.stamp(float(columns.host_time[-1]))
        self._add(topic, stamp, encode_raw(columns, dtype=dtype, start=self._start))
        self.written[topic] += len(samples)

    def event(self, host_time: float, text: str, *, level: int = INFO) -> None:
        """Write an event to the topic `/events`.

        Args:
            host_time: Host time of the event [s].
            text: Description of the event.
            level: Severity: `INFO`, `WARNING` or `ERROR`.
        """
        stamp = self.stamp(host_time)
        message = CdrWriter().time(stamp).uint8(level).text("zebro_lab")
        message.text(text).text("").text("").uint32(0)
        self._add(EVENTS, stamp, message.message())

    def count(self, host_time: float, stream: str, counters: Counters, *, dropped: int) -> None:
        """Write the counters of a stream to its topic `/STREAM/counters`.

        Args:
            host_time: Host time of the counters [s].
            stream: Name of the stream.
            counters: Samples received, lost, damaged and so on so far.
            dropped: Samples dropped so far because the queue to the disk was full.
        """
        message = CdrWriter()
        for field in fields(Counters):
            message.uint64(getattr(counters, field.name))
        stamp = self.stamp(host_time)
        self._add(f"/{stream}/counters", stamp, message.uint64(dropped).message())

    def flush(self) -> None:
        """Pass all buffered data to the operating system; they survive a crash of this process."""
        self._writer.flush()
        vars(self._writer).get(_KEPT, []).clear()

    def finish(self) -> None:
        """Write the index and the end of the log; the file stays open."""
        self._writer.finish()

    def stamp(self, host_time: float) -> int:
        """Convert host time [s] to Unix time [ns] by the start of the run, not the wall clock."""
        return self._start_ns + round((host_time - self._start) * 1e9)

    def _register(self, topic: str, schema: str, metadata: Mapping[str, str] | None = None) -> None:
        """Register the channel of a topic, and its schema where it is new."""
        for writer in self._writers if schema not in self._schemas else ():
            number = writer.register_schema(schema, SchemaEncoding.ROS2, _SCHEMAS[schema].encode())
            self._schemas[schema] = number
        for writer in self._writers:
            self._channels[topic] = writer.register_channel(
                topic, MessageEncoding.CDR, self._schemas[schema], dict(metadata or {})
            )

    def _add(self, topic: str, stamp: int, message: bytes) -> None:
        """Write a message with the next sequence number of its topic, at a stamp [ns].

        Times of logging never decrease: without an index, readers need messages in that order.
        """
        number = self._messages[topic]
        self._messages[topic] += 1
        self._latest = max(self._latest, stamp)
        self._writer.add_message(self._channels[topic], self._latest, message, stamp, number)
