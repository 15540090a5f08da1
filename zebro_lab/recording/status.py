# SPDX-License-Identifier: MIT
"""Status of a recording: first samples, rates and counters of its streams, remaining duration."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from rig.acquisition import Acquisition, Device
from rig.device import Counters, Sample
from zebro_lab.recording.recorder import COUNT_EVERY, RunRecorder

FIRST_SAMPLE: Final = 10.0
"""Timeout for the first sample of every stream, if a duration is set; it counts from then [s]."""


@dataclass(frozen=True)
class StreamStatus:
    """Status of a stream.

    Attributes:
        source: Source of the samples.
        rate: Sample rate over about the last second; 0 in the first one [Hz].
        counters: Counters of the stream so far.
        dropped: Number of samples dropped because the recorder's queue was full.
        newest: Takes the newest samples since its last call.
    """

    source: str
    rate: float
    counters: Counters
    dropped: int
    newest: Callable[[], Sequence[Sample]] = tuple


@dataclass(frozen=True)
class RecordStatus:
    """Status of a recording.

    Attributes:
        folder: The run folder.
        elapsed: Time since the last stream sent its first sample [s]; 0 before.
        duration: Planned duration from the first samples [s]; None for no limit.
        streams: Status of each stream, by its name.
    """

    folder: Path
    elapsed: float
    duration: float | None
    streams: Mapping[str, StreamStatus] = field(default_factory=dict)


class StreamWatch:
    """Timing and counters of all streams of a recording, for the log and for the watcher.

    Args:
        recorder: Writer of the run.
        readers: Reader of each stream, by its name.
        devices: Devices that the readers read.
        duration: Planned duration from the first samples [s]; None for no limit.
    """

    def __init__(
        self,
        recorder: RunRecorder,
        readers: Mapping[str, Acquisition],
        devices: Iterable[Device],
        duration: float | None,
    ) -> None:
        self._recorder = recorder
        self._readers = readers
        self._sources = {device.name: device.stream.source for device in devices}
        self._duration = duration
        self._rates = dict.fromkeys(readers, 0.0)
        self._before = (recorder.start, dict.fromkeys(readers, 0))
        self._began: float | None = None

    def left(self, now: float) -> float:
        """Return the remaining duration at host time `now` [s], 0 or less after the end.

        All of it before every stream has sent a sample; infinity without a planned duration.
        """
        if self._duration is None:
            return float("inf")
        began = self._first_samples()
        return self._duration if began is None else began + self._duration - now

    def problem(self, now: float) -> str | None:
        """Return the failure of recorder or reader, or which streams are silent; None without.

        Silent is a stream without any sample `FIRST_SAMPLE` after the run's start; it is a problem
        only with a planned duration.
        """
        problem = self._recorder.failure or reading_failure(self._readers)
        waited = now - self._recorder.start
        if problem is None and self._duration is not None and waited > FIRST_SAMPLE:
            silent = [name for name, reader in self._readers.items() if reader.first is None]
            if silent:
                rejected = sum(self._readers[name].counters.rejected for name in silent)
                advice = "check that the device is connected and switched on"
                if rejected:
                    advice = (
                        f"bytes arrive, but none of {rejected} packets is valid: check the baud "
                        "rate and that the profile is the device's"
                    )
                return (
                    f"received no sample of {', '.join(silent)} within {FIRST_SAMPLE:g} s, but the "
                    "duration of the run counts from when every device has sent one; "
                    f"{advice}, or record without it"
                )
        return problem

    def count(self) -> None:
        """Pass the counters of all streams to the recorder."""
        for name, reader in self._readers.items():
            self._recorder.count(name, reader.counters)

    def status(self, now: float) -> RecordStatus:
        """Return the status at host time `now`; rates are renewed every `COUNT_EVERY`."""
        began, received = self._before
        if now - began >= COUNT_EVERY:
            current = {name: r.counters.received for name, r in self._readers.items()}
            self._rates = {name: (current[name] - received[name]) / (now - began)
                           for name in current}  # fmt: skip
            self._before = (now, current)
        streams = {
            name: StreamStatus(
                self._sources[name], self._rates[name], reader.counters,
                self._recorder.dropped(name), reader.tap.take,
            )
            for name, reader in self._readers.items()
        }  # fmt: skip
        first = self._first_samples()
        elapsed = 0.0 if first is None else now - first
        return RecordStatus(self._recorder.folder, elapsed, self._duration, streams)

    def _first_samples(self) -> float | None:
        """Return the host time of the last stream's first sample, from which `duration` counts.

        None before. The first time, a planned duration is stored for the end record, and the
        readers are told when to end.
        """
        firsts = [reader.first for reader in self._readers.values()]
        known = [first for first in firsts if first is not None]
        if self._began is None and len(known) == len(firsts):
            self._began = max(known)
            if self._duration is not None:
                self._recorder.count_duration(self._duration, since=self._began)
                for reader in self._readers.values():
                    reader.end_at(self._began + self._duration)
        return self._began


def reading_failure(readers: Mapping[str, Acquisition]) -> str | None:
    """Return `STREAM: TYPE: MESSAGE` of the first reader that failed; None without a failure."""
    for name, reader in readers.items():
        if reader.failure is not None:
            return f"{name}: {type(reader.failure).__name__}: {reader.failure}"
    return None
