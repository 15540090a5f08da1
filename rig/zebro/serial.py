# SPDX-License-Identifier: MIT
"""Leg angles on a serial line: packets of a bridge, and registers that are dumped or polled."""

from typing import Final

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from rig.errors import ProtocolError
from rig.links.byte_link import ByteLink, LinkedStream
from rig.links.packet import Kind, TrailerFramer
from rig.links.packet_stream import PacketStream
from rig.zebro.commands import LeftStill, milliseconds
from rig.zebro.profile import DUMP_REGISTERS, LegProfile


class PacketLegs(LeftStill, PacketStream):
    """Stream of the layout `packet`; implements the protocols `Stream` and `LegCommands`.

    Leaving the driver stops legs that it has moved; those that it only read go on.

    Args:
        link: Bytes to and from the bridge.
        profile: Profile of the robot, of the layout `packet`.
        clock: Host time.
    """

    def __init__(self, link: ByteLink, *, profile: LegProfile, clock: Clock = SYSTEM_CLOCK) -> None:
        super().__init__(
            link,
            name="legs",
            kind=Kind.LEGS,
            body=profile.words(6),
            rate=profile.rate,
            possible=profile.possible,
            clock=clock,
        )
        self.profile = profile

    def set_points(self, counts: tuple[int, ...], duration: float) -> bool:
        """Send the command to turn every leg to a count; see `LegCommands.set_points`.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].

        Returns:
            Whether the link took the command.
        """
        body = self.profile.words(7).pack(*counts, milliseconds(duration))
        self._moved = True
        return self.send(Kind.LEG_SET_POINTS, body)

    def stop(self) -> bool:
        """Send the command to stop every leg where it is; return whether the link took it."""
        return self.send(Kind.STOP)


SYNC: Final = bytes.fromhex("FF4512EA4B")
"""Trailer of a dump."""
DUMP_LENGTH: Final = DUMP_REGISTERS + len(SYNC)
"""Length of a dump with its trailer [bytes]."""
ANSWER_TIMEOUT: Final = 0.05
"""Timeout of an answer to a poll [s]."""
QUIET_AFTER_FAILURE: Final = 0.1
"""Pause after an incomplete answer, so that a late one arrives before the next request [s]."""


class _RegisterStream(LinkedStream[ByteLink]):
    """Base of the streams of the layouts `dump` and `poll`, with link, profile and counters."""

    def __init__(self, link: ByteLink, *, profile: LegProfile, clock: Clock = SYSTEM_CLOCK) -> None:
        super().__init__(link, name="legs", clock=clock)
        self.profile = profile

    def _sample(self, counts: tuple[int, ...]) -> list[Sample]:
        """Return one sample of these counts, read now; none, counted as refused, if impossible."""
        if not self.profile.possible(counts):
            self._refused += 1
            return []
        self._received += 1
        return [Sample(self._clock.now(), None, None, counts)]


class DumpLegs(_RegisterStream):
    """Stream of the layout `dump`: 256 registers and a trailer of five bytes, again and again.

    Args:
        link: Bytes from one leg module.
        profile: Profile of the module, of the layout `dump`.
        clock: Host time.
    """

    def __init__(self, link: ByteLink, *, profile: LegProfile, clock: Clock = SYSTEM_CLOCK) -> None:
        super().__init__(link, profile=profile, clock=clock)
        self._framer = TrailerFramer(length=DUMP_LENGTH, trailer=SYNC)
        self._connections = 0

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far; dumps have no sequence number: losses are not counted.

        Dumps with impossible counts are refused.
        """
        return Counters(
            received=self._received,
            damaged=self._framer.damaged,
            refused=self._refused,
            resynchronised=self._framer.resynchronised,
            reconnected=self._link.reconnected,
        )

    def read(self, timeout: float) -> list[Sample]:
        """Return all samples that have arrived, waiting at most `timeout` for the first [s]."""
        data = self._link.read(timeout)
        if self._link.reconnected != self._connections:
            self._connections = self._link.reconnected
            self._framer.reset()
        samples = []
        for registers in self._framer.feed(data):
            counts = (
                int.from_bytes(registers[first : first + 2], self.profile.byte_order)
                for first in self.profile.registers.positions
            )
            samples += self._sample(tuple(counts))
        return samples

    def set_points(self, counts: tuple[int, ...], duration: float) -> bool:
        """Raise, since a robot that only dumps its registers takes no commands.

        The method exists because callers, such as `check_legs`, take any driver of legs as
        `LegCommands`: they get an error that names a way out, not an AttributeError.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].

        Raises:
            ProtocolError: Always.
        """
        raise ProtocolError(
            f"profile '{self.profile.name}' has the layout 'dump', which takes no set-points; use "
            "a robot and a profile of the layout 'packet', 'can' or 'poll'"
        )

    def stop(self) -> bool:
        """Send nothing, and return False, since no link took a command: this robot takes none.

        It does not raise: a recording calls it in its clean-up, also after `set_points` has raised.
        """
        return False


class PolledLegs(LeftStill, _RegisterStream):
    """Stream of the layout `poll`: each reading is requested, and answered by register values.

    A request is read command, first register and number of registers, one byte each. Readings
    are requested at the profile's rate. Buffered bytes are discarded before each request, so that
    a late answer is never taken for the next one.

    Leaving the driver stops legs that it has moved; those that it only read go on.

    Args:
        link: Bytes to and from the bridge.
        profile: Profile of the robot, of the layout `poll`.
        clock: Host time.
    """

    def __init__(self, link: ByteLink, *, profile: LegProfile, clock: Clock = SYSTEM_CLOCK) -> None:
        super().__init__(link, profile=profile, clock=clock)
        self._answer = profile.words(len(profile.legs))
        self._next_at = clock.now()
        self._damaged = 0
        self._resynchronised = 0
        self._out_of_sync = False

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far; losses are not counted.

        A request without a complete answer counts as damaged, also where the link is disconnected;
        impossible counts are refused.
        """
        return Counters(
            received=self._received,
            damaged=self._damaged,
            refused=self._refused,
            resynchronised=self._resynchronised,
            reconnected=self._link.reconnected,
        )

    def read(self, timeout: float) -> list[Sample]:
        """Wait until the next reading is due, request it, and return its sample.

        There is none where the reading is due later than `timeout` [s], or the answer is missing,
        incomplete or impossible. Waiting for the answer adds up to `ANSWER_TIMEOUT`.

        Raises:
            RigTimeout: The port accepts no bytes within its timeout.
        """
        now = self._clock.now()
        wait = self._next_at - now
        self._clock.sleep(min(max(wait, 0.0), timeout))
        if wait > timeout:
            return []
        self._next_at = max(self._next_at, now) + 1 / self.profile.rate
        answer = self._request()
        if answer is None:
            self._damaged += 1
            self._out_of_sync = True
            # Pause first: an answer does not say to which request it belongs.
            self._next_at = self._clock.now() + QUIET_AFTER_FAILURE
            return []
        self._resynchronised += self._out_of_sync
        self._out_of_sync = False
        return self._sample(self._answer.unpack(answer))

    def set_points(self, counts: tuple[int, ...], duration: float) -> bool:
        """Send the command to turn every leg to a count; see `LegCommands.set_points`.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].

        Returns:
            Whether the link took the command.
        """
        values = (*counts, milliseconds(duration))
        data = self.profile.words(len(values)).pack(*values)
        self._moved = True
        return self._write(self.profile.registers.set_points[0], data)

    def stop(self) -> bool:
        """Send the command to stop every leg where it is; return whether the link took it."""
        return self._write(self.profile.registers.stop, b"\x01")

    def _write(self, first: int, data: bytes) -> bool:
        """Write bytes to the registers from `first` on; return whether the link took them."""
        head = bytes((self.profile.registers.write_command, first, len(data)))
        return self._link.write(head + data)

    def _request(self) -> bytes | None:
        """Request all positions and return their bytes; None without a complete answer in time."""
        self._link.read(0.0)  # leftovers of an answer that came too late
        registers, size = self.profile.registers, self._answer.size
        request = bytes((registers.read_command, registers.positions[0], size))
        if not self._link.write(request):
            return None
        end = self._clock.now() + ANSWER_TIMEOUT
        answer = b""
        while len(answer) < size and (left := end - self._clock.now()) > 0:
            answer += self._link.read(left)
        return answer if len(answer) == size else None
