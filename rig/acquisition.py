# SPDX-License-Identifier: MIT
"""Read devices, each in its own thread, and pass their samples to a sink."""

import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from logging import WARNING
from typing import Final, Protocol

from rig.clock import SYSTEM_CLOCK, Clock
from rig.clock_watch import ClockWatch
from rig.device import Counters, Sample, Stream
from rig.errors import RigTimeout
from rig.safety import SilenceGuard
from rig.sample_queue import LossyTap

READ_WAIT: Final = 0.1
"""Longest single wait of a read [s]."""
SILENCE: Final = 1.0
"""Silence after which an event is logged [s]."""
JOIN_TIMEOUT: Final = 5.0
"""Longest wait for the end of a reader thread [s]."""


class SampleSink(Protocol):
    """Non-blocking receiver of samples and events of devices."""

    def write(self, stream: str, samples: Sequence[Sample]) -> bool:
        """Queue samples of a stream without blocking; drop them where there is no room.

        Args:
            stream: Name of the stream.
            samples: Samples of the stream, in order.

        Returns:
            Whether there was room for them.
        """
        ...

    def event(self, text: str, *, level: int = ...) -> None:
        """Queue an event that happened now, for the log.

        Args:
            text: Description of the event.
            level: Severity, as in `logging`.
        """
        ...


@dataclass(frozen=True)
class Device:
    """A device to be recorded, with what its reader thread does besides reading.

    Attributes:
        stream: Driver of the device, not yet entered.
        check: Called in the reader thread with the samples of every read that has any; raises where
            a limit is exceeded, which ends the reading. None checks nothing.
        command: Called in the reader thread before every read, with the host time [s]: sends
            set-points of a gait. None commands nothing.
        at_end: Called once after reading has ended, before the driver is left: stops what `command`
            moved. None does nothing.
        pause: Pause between two reads, to save CPU time where the device sends its own time; 0
            reads without a pause [s].
    """

    stream: Stream
    check: Callable[[Sequence[Sample]], None] | None = None
    command: Callable[[float], None] | None = None
    at_end: Callable[[], object] | None = None
    pause: float = 0.0

    @property
    def name(self) -> str:
        """Name of the stream."""
        return self.stream.name


class Acquisition:
    """Reader thread of one device, until a stop is requested, its end time has passed, or it fails.

    It writes samples to the sink, and events when samples are lost, or when the device restarts, is
    connected again, is silent for `SILENCE` or sends again.

    Args:
        device: The device; its driver has been entered.
        sink: Receiver of the samples and of events of the link.
        start: Host time at which the run began [s].
        clock: Host time.

    Attributes:
        name: Name of the stream.
        counters: Counters of the stream, as of its last read.
        tap: Ring buffer of the newest samples, for viewers.
        clock_watch: Comparison of the device's clock with the host's.
        first: Host time of the first sample; None until a sample has arrived [s].
        failure: Exception that ended the reading early, or that says that the thread did not end
            in time; None where there is none.
    """

    def __init__(
        self, device: Device, *, sink: SampleSink, start: float, clock: Clock = SYSTEM_CLOCK
    ) -> None:
        self.name = device.name
        self.counters = Counters()
        self.tap = LossyTap()
        self.clock_watch = ClockWatch(start=start)
        self.first: float | None = None
        self.failure: BaseException | None = None
        self._device = device
        self._sink = sink
        self._clock = clock
        self._silent = False
        self._done = threading.Event()
        self._until = float("inf")
        self._thread = threading.Thread(target=self._run, daemon=True, name=device.name)

    def start(self) -> None:
        """Start the reader thread.

        Raises:
            RuntimeError: The system allows no more threads.
        """
        self._thread.start()

    def end_at(self, until: float) -> None:
        """Set the host time at which the thread ends by itself, without a call of `stop` [s]."""
        self._until = until

    def request_stop(self) -> None:
        """Request the thread to end after its current read, or one more; does not wait for it."""
        self._done.set()

    def stop(self) -> None:
        """Request the thread to end and wait for it, at most `JOIN_TIMEOUT`.

        If it does not end in time and has not failed before, `failure` becomes a `RigTimeout`.
        """
        self._done.set()
        if self._thread.is_alive():
            self._thread.join(JOIN_TIMEOUT)
            if self._thread.is_alive() and self.failure is None:
                self.failure = RigTimeout("the reader thread did not end", waited=JOIN_TIMEOUT)

    def _run(self) -> None:
        """Read until a stop, the end time or an exception, which is kept in `failure`."""
        device = self._device
        try:
            guard = SilenceGuard(self.name, limit=SILENCE, now=self._clock.now())
            while self._clock.now() < self._until and not self._done.is_set():
                if device.command is not None:
                    device.command(self._clock.now())
                self._read(guard, READ_WAIT)
                if device.pause > 0:
                    self._done.wait(min(device.pause, self._until - self._clock.now()))
            if device.pause > 0:
                self._read(guard, 0.0)  # what came during the pause
        except BaseException as failure:  # noqa: BLE001, RUF100 - kept for the owner, who ends the run
            self.failure = failure

    def _read(self, guard: SilenceGuard, wait: float) -> None:
        """Pass the samples of one read to sink, tap and clock watch; then check limits and link.

        The samples are stored before the limit check, which may raise, so that the log has them.
        """
        device = self._device
        samples = device.stream.read(wait)
        if samples:
            if self.first is None:
                self.first = samples[0].host_time
            self._sink.write(self.name, samples)
            self.tap.put(samples)
            self.clock_watch.add(samples)
            if device.check is not None:
                device.check(samples)
        self._log_link_events(device.stream.counters)
        self._check_silence(guard, samples)

    def _log_link_events(self, counters: Counters) -> None:
        """Log an event for each of these counters that has grown: reconnected, restarted, lost."""
        before, self.counters = self.counters, counters
        for what in ("reconnected", "restarted"):
            if getattr(counters, what) > getattr(before, what):
                self._sink.event(f"{self.name}: {what}", level=WARNING)
        if counters.lost > before.lost:
            missing = counters.lost - before.lost
            self._sink.event(f"{self.name}: {missing} samples lost", level=WARNING)

    def _check_silence(self, guard: SilenceGuard, samples: Sequence[Sample]) -> None:
        """Log one event when no sample came for `SILENCE`, and one when samples arrive again."""
        try:
            guard.check(samples, now=self._clock.now())
        except RigTimeout as silence:
            if not self._silent:
                self._sink.event(f"{self.name}: silent ({silence})", level=WARNING)
            self._silent = True
        else:
            if self._silent:
                self._sink.event(f"{self.name}: samples arrive again", level=WARNING)
            self._silent = False


@contextmanager
def acquiring(
    devices: Sequence[Device], *, sink: SampleSink, start: float, clock: Clock = SYSTEM_CLOCK
) -> Iterator[Mapping[str, Acquisition]]:
    """Read each device in a thread of its own while the body of the `with` statement runs.

    After the body the threads are stopped, and then each device's `at_end` is called. A failure in
    a thread ends only that thread, and is kept in its `Acquisition.failure`.

    Args:
        devices: The devices; their drivers have been entered.
        sink: Receiver of the samples and of events of the links.
        start: Host time at which the run began [s].
        clock: Host time.

    Yields:
        The reader of each device, by the name of its stream.

    Raises:
        RuntimeError: The system allows no more threads.
    """
    readers = {d.name: Acquisition(d, sink=sink, start=start, clock=clock) for d in devices}
    with ExitStack() as stack:
        for device in devices:  # first in, last out: called after every reader has stopped
            if device.at_end is not None:
                stack.callback(device.at_end)
        for reader in readers.values():
            stack.callback(reader.stop)
            reader.start()
        try:
            yield readers
        finally:
            for reader in readers.values():
                reader.request_stop()  # all at once, so that their streams end together
