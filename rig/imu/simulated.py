# SPDX-License-Identifier: MIT
"""Simulated inertial measurement unit on a rocking body.

Not modelled: noise, drift, temperature, vibration and the unit's own filter.
"""

from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from rig.imu.profile import ImuProfile, encode_orientation
from rig.links.faults import PERFECT_LINE, Faults, FaultyWire
from rig.links.packet import TICK, Kind, Packet, encode_packet
from rig.zebro.profile import Array

GRAVITY: Final = 9.81
"""Acceleration of gravity [m/s²]."""
STEP: Final = 1e-4
"""Step of the finite difference that gives the angular rate [s]."""


def rocking(time: float) -> tuple[float, float, float]:
    """Compute the attitude of a body that oscillates at 1 Hz in roll and pitch as it turns left.

    Args:
        time: Time since the unit was switched on [s].

    Returns:
        Roll, pitch and yaw [rad].
    """
    swing = 2 * np.pi * time
    return 0.08 * float(np.sin(swing)), 0.05 * float(np.cos(swing)), 0.1 * time


class SimulatedImu:
    """Simulated unit that sends packets; implements the protocol `ByteTwin`.

    Args:
        profile: Scale of the counts, mounting and rate of the unit.
        faults: Transmission errors of the line.
        rng: Random generator of the transmission errors.
    """

    def __init__(
        self,
        *,
        profile: ImuProfile,
        faults: Faults = PERFECT_LINE,
        rng: np.random.Generator,
    ) -> None:
        self.source = "sim:imu"
        self._profile = profile
        self._wire = FaultyWire(faults, rng=rng)
        self._switched_on: float | None = None
        self._number = 0

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
        frames = [self._encode(number) for number in range(self._number, due)]
        self._number = due
        return self._wire.stream(frames)

    def _encode(self, number: int) -> bytes:
        time = number / self._profile.rate
        counts = encode_orientation(self._profile, *_motion(time))
        ticks = round(time / TICK)
        body = self._profile.body.pack(*counts)
        return encode_packet(Packet(Kind.ORIENTATION, number, ticks, body))


def _motion(time: float) -> tuple[Rotation, Array, Array]:
    """Compute the motion of the `rocking` body at a time [s].

    Returns:
        Rotation from body to inertial frame; angular rate [rad/s] and specific force [m/s²] in the
        body's axes, each of shape (3,). The acceleration is taken as 0.
    """
    rotation = _rotation(time)
    turned = (rotation.inv() * _rotation(time + STEP)).as_rotvec()
    return rotation, turned / STEP, rotation.inv().apply([0.0, 0.0, GRAVITY])


def _rotation(time: float) -> Rotation:
    roll, pitch, yaw = rocking(time)
    return Rotation.from_euler("ZYX", [yaw, pitch, roll])
