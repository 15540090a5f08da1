# SPDX-License-Identifier: MIT
"""Simulated inertial measurement unit on a body whose attitude over time is given.

Not modelled: noise, drift, temperature, vibration, acceleration of the body and the unit's filter.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from model.arrays import Array
from rig.imu.profile import ImuProfile, encode_orientation
from rig.links.faults import PERFECT_LINE, Faults, FaultyWire
from rig.links.packet import TICK, Kind, Packet, encode_packet

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

GRAVITY: Final = 9.81
"""Acceleration of gravity [m/s²]."""
Attitude: TypeAlias = Callable[[float], tuple[float, float, float]]
"""Computes roll, pitch and yaw of a body [rad] at a time that never decreases [s]."""


def at_rest(_time: float) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of a level body that stands still: zeros [rad]."""
    return 0.0, 0.0, 0.0


class SimulatedImu:
    """Simulated unit that sends packets; implements the protocol `ByteTwin`.

    The angular rate of a sample is the mean since the sample before, zero in the first.

    Args:
        profile: Scale of the counts, mounting and rate of the unit.
        attitude: Attitude of the body that carries the unit, by the clock of `poll`.
        faults: Transmission errors of the line.
        rng: Random generator of the transmission errors.
    """

    def __init__(
        self,
        *,
        profile: ImuProfile,
        attitude: Attitude = at_rest,
        faults: Faults = PERFECT_LINE,
        rng: np.random.Generator,
    ) -> None:
        self.source = "sim:imu"
        self._profile = profile
        self._attitude = attitude
        self._wire = FaultyWire(faults, rng=rng)
        self._switched_on: float | None = None
        self._number = 0
        self._before: Rotation | None = None

    def poll(self, now: float, received: bytes) -> bytes:
        """Return the packets that are due; the first call switches the unit on.

        Args:
            now: Time, never decreasing [s].
            received: Bytes from the host; ignored, as the real unit does.

        Returns:
            Bytes to the host since the last poll.
        """
        del received
        if self._switched_on is None:
            self._switched_on = now
        due = int((now - self._switched_on) * self._profile.rate + 1e-9) + 1
        frames = [self._encode(number, self._switched_on) for number in range(self._number, due)]
        self._number = due
        return self._wire.stream(frames)

    def _encode(self, number: int, switched_on: float) -> bytes:
        """Encode the packet of a sample, taken `number` sample intervals after switching on."""
        time = number / self._profile.rate
        counts = encode_orientation(self._profile, *self._motion(switched_on + time))
        ticks = round(time / TICK)
        body = self._profile.body.pack(*counts)
        return encode_packet(Packet(Kind.ORIENTATION, number, ticks, body))

    def _motion(self, now: float) -> tuple["Rotation", Array, Array]:
        """Compute the motion of the body at the time of the next sample [s].

        Returns:
            Rotation from body to inertial frame; angular rate [rad/s] and specific force [m/s²] in
            the body's axes, each of shape (3,). The acceleration is taken as 0.
        """
        from scipy.spatial.transform import Rotation

        roll, pitch, yaw = self._attitude(now)
        rotation = Rotation.from_euler("ZYX", [yaw, pitch, roll])
        before, self._before = self._before or rotation, rotation
        rate = (before.inv() * rotation).as_rotvec() * self._profile.rate
        return rotation, rate, rotation.inv().apply([0.0, 0.0, GRAVITY])
