# SPDX-License-Identifier: MIT
"""Protocols of devices: streams of raw samples, drives, load cells; their counters and limits.

Real, simulated and replayed devices implement the same protocols. Samples hold raw counts. Angles,
speeds and forces are computed from the counts with the device's profile, at any later time.
"""

from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass
from operator import sub
from typing import NamedTuple, Protocol, Self

from rig.clock import SYSTEM_CLOCK, Clock


class Sample(NamedTuple):
    """One raw reading as it arrived. A named tuple: at 7 kHz a frozen dataclass is too slow.

    Attributes:
        host_time: Time at which the host read the sample, by the clock of the stream [s].
        device_time: Time at which the device took the sample, by the device's own clock,
            unwrapped; None where the protocol carries no time, or its frame was lost [s].
        sequence: Sequence number of the sample, unwrapped, strictly increasing; None where the
            protocol has none.
        counts: Raw values in the order of the protocol, units of the device.
        status: Status or error word of the device; 0 without a fault or where none is sent.
        channel: Index of the device among several on one link: node of a drive, 0 elsewhere.
    """

    host_time: float
    device_time: float | None
    sequence: int | None
    counts: tuple[float, ...]
    status: int = 0
    channel: int = 0


@dataclass(frozen=True)
class Counters:
    """Counters of received, lost and damaged samples of a stream so far.

    Where a protocol numbers its samples and the device did not restart, received + lost is the
    number of samples that the device sent from the first to the last one received. A damaged or
    refused frame is counted in `damaged` or `refused` when it arrives, and in `lost` as well when
    the next good frame shows the gap.

    Attributes:
        received: Samples returned by the driver.
        lost: Samples missing according to the sequence numbers.
        damaged: Frames discarded for a wrong checksum, length or form.
        repeated: Samples discarded because they are duplicates, or arrived after a later sample.
        refused: Whole frames discarded for impossible values, or meant for another device.
        resynchronised: Number of times that good frames followed damaged ones.
        reconnected: Number of times that the link came back after a disconnection.
        restarted: Number of times that the device restarted its sequence numbers.
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
        """Number of frames that arrived and were discarded: damaged, repeated or refused."""
        return self.damaged + self.repeated + self.refused

    def since(self, earlier: "Counters") -> "Counters":
        """Return what was counted after `earlier`, a state of the same counters."""
        return Counters(*map(sub, astuple(self), astuple(earlier)))


class Stream(Protocol):
    """Context manager that returns the samples of a device at each call of `read`.

    A stream is read by one thread. Leaving it closes the link; before, discs of a rig are stopped.
    """

    @property
    def name(self) -> str:
        """Name of the stream, as in log topics and counter tables."""
        ...

    @property
    def source(self) -> str:
        """Where the samples come from: `real`, `sim:WHAT` or `replay:WHAT`."""
        ...

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far."""
        ...

    def read(self, timeout: float) -> Sequence[Sample]:
        """Return all samples that have arrived, waiting at most `timeout` for the first.

        Args:
            timeout: Longest wait; 0 does not wait [s].

        Returns:
            Samples in the order of the device; none after a timeout or without a connection.

        Raises:
            RigError: The device is not the one of the profile, or its link takes no bytes.
        """
        ...

    def __enter__(self) -> Self: ...

    def __exit__(self, *exception: object) -> None: ...


class Drive(Protocol):
    """Speed-controlled motor that turns one disc.

    Reading the stream of a drive feeds the watchdog inside it.
    """

    @property
    def name(self) -> str:
        """Name of the disc that the motor turns."""
        ...

    def arm(self, timeout: float) -> None:
        """Energise with set-point 0; wait at most `timeout` until the drive confirms it [s].

        Raises:
            RigTimeout: The drive did not energise in time.
            DeviceFault: The drive reports a fault.
        """
        ...

    def set_speed(self, omega: float) -> None:
        """Command an angular speed of the disc, positive driving [rad/s].

        Raises:
            LimitExceeded: The magnitude of the speed is above the rig's limit, or NaN.
            RigTimeout: The link does not take the command.
        """
        ...

    def disarm(self) -> None:
        """Command standstill and, if possible, de-energise; errors of sending are suppressed."""
        ...


@dataclass(frozen=True)
class Limits:
    """Largest magnitudes allowed on a rig.

    Attributes:
        speed: Angular speed of a disc [rad/s].
        normal_force: Normal force [N].
        traction_force: Traction force [N].
        lateral_force: Force on the load cell's third axis; None where not limited [N].
        torque: Torque about any axis of the load cell; None where not limited [N m].
        temperature_celsius: Temperature of a drive or its motor; None where not limited [degC].
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
    """Yield a stream's samples one by one as they arrive, and end after `duration`.

    Args:
        stream: An open stream.
        duration: Time for which the stream is read, also where it sends nothing [s].
        clock: Host time.
        wait: Timeout of a single read [s].

    Yields:
        The samples, in order.
    """
    end = clock.now() + duration
    while (left := end - clock.now()) > 0:
        yield from stream.read(min(wait, left))
