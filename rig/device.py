# SPDX-License-Identifier: MIT
"""What every device is: a stream of raw samples, and what can be asked of drives and load cells.

Real, simulated and replayed devices are siblings behind these protocols. Raw counts travel; angles,
speeds and forces are derived from them with the device's profile, now or years later.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import NamedTuple, Protocol, Self

from rig.clock import SYSTEM_CLOCK, Clock


class Sample(NamedTuple):
    """One reading, raw, as it arrived. A named tuple: at 7 kHz a frozen dataclass costs too much.

    Attributes:
        host_time: When the host read it, by the clock the stream was given [s].
        device_time: When the device took it, by the device's own clock, wraps undone; None where
            the protocol carries no time [s].
        sequence: Number of the sample, wraps undone, strictly increasing; None where the protocol
            numbers nothing.
        counts: Raw values in the order of the protocol, units of the device.
        status: Status or error word of the device; 0 where all is well or none is sent.
        channel: Which of several devices on one link: node of a drive, 0 elsewhere.
    """

    host_time: float
    device_time: float | None
    sequence: int | None
    counts: tuple[float, ...]
    status: int = 0
    channel: int = 0


@dataclass(frozen=True)
class Counters:
    """What happened to a stream so far.

    Where a protocol numbers its samples and the device did not restart, received + lost is how many
    the device sent between the first and the last one received. A damaged or refused frame counts
    as such when it is seen, and in `lost` when the next good one shows the hole.

    Attributes:
        received: Samples handed on.
        lost: Samples that the numbering shows to be missing.
        damaged: Frames refused for their checksum, length or form.
        repeated: Samples refused because their number had already passed: doubled, late.
        refused: Whole frames refused for impossible values, or meant for another device.
        resynchronised: Times that good frames followed damaged ones.
        reconnected: Times that the link came back after it was gone.
        restarted: Times that the device began to number anew.
    """

    received: int = 0
    lost: int = 0
    damaged: int = 0
    repeated: int = 0
    refused: int = 0
    resynchronised: int = 0
    reconnected: int = 0
    restarted: int = 0

    @property
    def rejected(self) -> int:
        """Count the frames that arrived and were not handed on."""
        return self.damaged + self.repeated + self.refused


class Stream(Protocol):
    """A source of samples: open as a context manager, then read again and again.

    A stream is read by one thread. Leaving it closes the link and de-energises what it drives.
    """

    @property
    def name(self) -> str:
        """Name of the stream: topic in a log, row of a counter table."""
        ...

    @property
    def source(self) -> str:
        """Where the samples come from: `real`, `sim:WHAT` or `replay:WHAT`."""
        ...

    @property
    def counters(self) -> Counters:
        """What happened so far."""
        ...

    def read(self, timeout: float) -> Sequence[Sample]:
        """Hand on all samples that have arrived, waiting at most `timeout` for the first.

        Args:
            timeout: Longest wait; 0 does not wait [s].

        Returns:
            Samples in the order of the device; none where the time ran out or the link is gone.
        """
        ...

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...


class Drive(Protocol):
    """A speed-controlled motor that turns one disc.

    A drive needs its stream to be read: that is what feeds the watchdog inside it.
    """

    @property
    def name(self) -> str:
        """Name of the disc that it turns."""
        ...

    def arm(self, timeout: float) -> None:
        """Energise at standstill, waiting at most `timeout` [s].

        Raises:
            RigTimeout: The drive did not follow.
            DeviceFault: The drive reports a fault.
        """
        ...

    def set_speed(self, omega: float) -> None:
        """Command an angular speed of the disc, positive driving [rad/s].

        Raises:
            LimitExceeded: The speed is beyond the drive's limit.
        """
        ...

    def disarm(self) -> None:
        """Command standstill and de-energise; never fails for a drive that is not there."""
        ...


class LoadCellStream(Stream, Protocol):
    """A stream of forces whose zero the device can set by itself."""

    def bias(self) -> None:
        """Make what the cell reads now its zero."""
        ...


@dataclass(frozen=True)
class Limits:
    """Largest magnitudes that a rig is allowed.

    Attributes:
        speed: Angular speed of a disc [rad/s].
        normal_force: Normal force [N].
        traction_force: Traction force [N].
        lateral_force: Force on the load cell's third axis; None where nothing is said [N].
        torque: Torque on any axis of the load cell; None where nothing is said [N m].
        temperature_celsius: Of a drive or its motor; None where nothing is said [degC].
    """

    speed: float
    normal_force: float
    traction_force: float
    lateral_force: float | None = None
    torque: float | None = None
    temperature_celsius: float | None = None


def iterate(
    stream: Stream, *, duration: float, clock: Clock = SYSTEM_CLOCK, wait: float = 0.1
) -> Iterator[Sample]:
    """Yield a stream's samples one by one for a while; silence does not hold it up.

    Args:
        stream: An open stream.
        duration: How long to read [s].
        clock: Host time.
        wait: Longest single wait [s].

    Yields:
        The samples.
    """
    end = clock.now() + duration
    while (left := end - clock.now()) > 0:
        yield from stream.read(min(wait, left))
