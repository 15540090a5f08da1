# SPDX-License-Identifier: MIT
"""Write the MCAP log of a run incrementally, so that it is readable up to the last flush."""

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import IO, Final

import numpy as np

from rig.device import Counters, Sample
from rig.sample_columns import as_columns
from zebro_lab.mcap.cdr import CdrWriter
from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.raw_log import RAW_SCHEMAS, encode_raw, raw_topic
from zebro_lab.mcap.ros_messages import INFO, LOG, Schema, log_entry
from zebro_lab.mcap.stream_views import StreamView

EVENTS: Final = "/events"
COUNTERS: Final = Schema(
    "zebro_lab/msg/Counters",
    "# What happened to a stream so far.\n"
    + "".join(f"uint64 {field.name}\n" for field in fields(Counters))
    + "uint64 dropped  # by the recorder: nobody wrote them in time\n",
)
_CHUNK_BYTES: Final = 1 << 20  # flushing ends a chunk long before


class LogWriter:
    """Writer of a run's MCAP log: raw samples, display messages, events; not thread-safe.

    Args:
        file: Binary output file; writing to it begins at once.
        views: Converter of each stream's samples to display messages, by the stream's name.
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
        views: Mapping[str, StreamView],
        attachments: Mapping[str, str],
        start: float,
        start_ns: int,
    ) -> None:
        self.written = {raw_topic(name): 0 for name in views}
        self._views = views
        self._start, self._start_ns = start, start_ns
        self._log = MessageLog(file, chunk_size=_CHUNK_BYTES)
        self._log.register(EVENTS, LOG)
        for name, view in views.items():
            self._register(name, view)
        for name, text in attachments.items():
            self._log.attach(start_ns, name, "application/toml", text)

    def write(self, stream: str, samples: Sequence[Sample]) -> None:
        """Write samples of a stream: one message of raw counts, and its display messages.

        The message of raw counts is stamped with the time of the last sample.

        Args:
            stream: Name of the stream, one of `views`.
            samples: Next samples of the stream, at least one.
        """
        view = self._views[stream]
        dtype, _ = RAW_SCHEMAS[view.raw_schema]
        columns = as_columns(samples, dtype)
        host_time = columns.host_time - self._start
        stamps = (self._start_ns + np.rint(1e9 * host_time).astype(np.int64)).tolist()
        topic = raw_topic(stream)
        self._log.add(topic, stamps[-1], encode_raw(columns, dtype=dtype, start=self._start))
        self.written[topic] += len(samples)
        for shown, stamp, message in view.messages(columns, stamps):
            self._log.add(shown, stamp, message)

    def event(self, host_time: float, text: str, *, level: int = INFO) -> None:
        """Write an event to the topic `/events`.

        Args:
            host_time: Host time of the event [s].
            text: Description of the event.
            level: Severity: `INFO`, `WARNING` or `ERROR` of `ros_messages`.
        """
        stamp = self.stamp(host_time)
        self._log.add(EVENTS, stamp, log_entry(stamp, text, level=level))

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
        self._log.add(f"/{stream}/counters", stamp, message.uint64(dropped).message())

    def flush(self) -> None:
        """Pass all buffered data to the operating system; they survive a crash of this process."""
        self._log.flush()

    def finish(self) -> None:
        """Write the index and the end of the log; the file stays open."""
        self._log.finish()

    def stamp(self, host_time: float) -> int:
        """Convert host time [s] to Unix time [ns] by the start of the run, not the wall clock."""
        return self._start_ns + round((host_time - self._start) * 1e9)

    def _register(self, name: str, view: StreamView) -> None:
        _, text = RAW_SCHEMAS[view.raw_schema]
        raw = Schema(view.raw_schema, text)
        self._log.register(raw_topic(name), raw, metadata=view.metadata)
        for topic, schema in (*view.topics.items(), (f"/{name}/counters", COUNTERS)):
            self._log.register(topic, schema)
