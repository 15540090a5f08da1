# SPDX-License-Identifier: MIT
"""Leg angles on a CAN bus; the messages are those of `zebro-100-can.dbc`."""

import struct
from typing import Final

import can

from rig.clock import SYSTEM_CLOCK, Clock
from rig.device import Counters, Sample
from rig.links.byte_link import LinkedStream
from rig.links.can import CanLink
from rig.links.sequence import SequenceTracker, TimeUnwrapper
from rig.zebro.commands import LeftStill, milliseconds
from rig.zebro.profile import LegProfile

# Layouts written by hand: cantools decodes about 20 times slower. It serves tests and tools.
CLOCK: Final = struct.Struct("<HI")
"""Number of the positions that follow, and their device time [ticks]."""
POSITIONS: Final = struct.Struct("<6BH")
"""Count of each channel, and number of the positions."""
SET_POINTS: Final = struct.Struct("<6BH")
"""Target count of each channel, and duration of the motion [ms]."""
SEQUENCE_WRAP: Final = 1 << 16
"""Modulus of the numbers."""
TICKS_WRAP: Final = 1 << 32
"""Modulus of the device time [ticks]."""
TICK: Final = 1e-6
"""One tick of the device time [s]."""


class CanLegs(LeftStill, LinkedStream[CanLink]):
    """Stream of the layout `can`; implements the protocols `Stream` and `LegCommands`.

    CAN protects each frame with a checksum. The device time arrives in a separate frame before the
    positions of the same number; where that frame is lost, the positions have no device time.

    Leaving the driver stops legs that it has moved; those that it only read go on.

    Args:
        link: Link to the robot's bus.
        profile: Profile of the robot, of the layout `can`.
        clock: Host time.
    """

    def __init__(self, link: CanLink, *, profile: LegProfile, clock: Clock = SYSTEM_CLOCK) -> None:
        super().__init__(link, name="legs", clock=clock)
        self.profile = profile
        self._tracker = SequenceTracker(modulus=SEQUENCE_WRAP, rate=profile.rate)
        self._device_time = TimeUnwrapper(modulus=TICKS_WRAP, tick=TICK)
        self._stamp: tuple[int, int] | None = None

    @property
    def counters(self) -> Counters:
        """Counters of the stream so far; error and truncated frames of the bus count as damaged.

        Clock and position frames of a wrong length, and impossible counts, are refused.
        """
        return Counters(
            received=self._received,
            lost=self._tracker.lost,
            damaged=self._link.damaged,
            repeated=self._tracker.repeated,
            refused=self._refused,
            reconnected=self._link.reconnected,
            restarted=self._tracker.restarted,
        )

    def read(self, timeout: float) -> list[Sample]:
        """Return all samples that have arrived, waiting at most `timeout` for the first [s]."""
        messages = self._link.read(timeout)
        now = self._clock.now()
        found = (self._sample(message, now) for message in messages)
        samples = [sample for sample in found if sample is not None]
        self._received += len(samples)
        return samples

    def set_points(self, counts: tuple[int, ...], duration: float) -> bool:
        """Send the command to turn every leg to a count; see `LegCommands.set_points`.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].

        Returns:
            Whether the link took the command.
        """
        data = SET_POINTS.pack(*counts, milliseconds(duration))
        self._moved = True
        return self._link.write(self.profile.can_ids.set_points, data)

    def stop(self) -> bool:
        """Send the command to stop every leg where it is; return whether the link took it."""
        return self._link.write(self.profile.can_ids.stop, b"")

    def _sample(self, message: can.Message, now: float) -> Sample | None:
        """Return the sample of a position frame; keep a clock frame's time for the next one.

        None where the frame gives no sample; frames of a wrong length are counted as refused.
        """
        ids = self.profile.can_ids
        if message.arbitration_id == ids.clock and message.dlc == CLOCK.size:
            self._stamp = CLOCK.unpack(message.data)
        elif message.arbitration_id == ids.positions and message.dlc == POSITIONS.size:
            return self._positions(message.data, now)
        elif message.arbitration_id in (ids.clock, ids.positions):
            self._refused += 1
        return None

    def _positions(self, data: bytes | bytearray, now: float) -> Sample | None:
        """Return the sample of a position frame, or None where it is impossible, repeated or late.

        It has a device time only where the latest clock frame has the same number.
        """
        *counts, number = POSITIONS.unpack(data)
        if not self.profile.possible(tuple(counts)):
            self._refused += 1
            return None
        stamp = self._stamp
        ticks = stamp[1] if stamp is not None and stamp[0] == number else None
        elapsed = None if ticks is None else self._device_time.since(ticks)
        sequence = self._tracker.accept(number, now, elapsed)
        if sequence is None:
            return None
        time = None if ticks is None else self._device_time.unwrap(ticks)
        return Sample(now, time, sequence, tuple(counts))
