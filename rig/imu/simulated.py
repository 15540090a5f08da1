# SPDX-License-Identifier: MIT
"""Simulated inertial measurement unit on a body with a given motion.

Not modelled: temperature, vibration and the unit's own filter.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial.transform import Rotation

from rig.errors import ProtocolError
from rig.imu.profile import ImuProfile, encode_orientation
from rig.links.faults import PERFECT_LINE, Faults, FaultyWire
from rig.links.packet import TICK, Kind, Packet, encode_packet
from rig.zebro.profile import Array

GRAVITY: Final = 9.81
STEP: Final = 1e-4

Attitude = Callable[[float], tuple[float, float, float]]
"""Roll, pitch and yaw [rad] at a time [s]."""


@dataclass(frozen=True)
class ImuImperfections:
    """Noise and drift of a unit; the defaults are an ideal one.

    Attributes:
        angle_noise: Standard deviation of the orientation about each axis [rad].
        rate_noise: Standard deviation of the angular rate [rad/s].
        force_noise: Standard deviation of the specific force [m/s²].
        yaw_drift: Drift rate of the heading [rad/s].

    Raises:
        ProtocolError: A standard deviation is negative.
    """

    angle_noise: float = 0.0
    rate_noise: float = 0.0
    force_noise: float = 0.0
    yaw_drift: float = 0.0

    def __post_init__(self) -> None:
        for name in ("angle_noise", "rate_noise", "force_noise"):
            if not getattr(self, name) >= 0:
                raise ProtocolError(f"{name} is {getattr(self, name):g}; expected 0 or more")


PERFECT_UNIT = ImuImperfections()
"""A unit without noise and drift."""


def rocking(time: float) -> tuple[float, float, float]:
    """Compute the attitude of a body that oscillates in roll and pitch as it turns left.

    Args:
        time: Time since the beginning [s].

    Returns:
        Roll, pitch and yaw [rad].
    """
    swing = 2 * np.pi * time
    return 0.08 * float(np.sin(swing)), 0.05 * float(np.cos(swing)), 0.1 * time


class SimulatedImu:
    """Simulated unit that sends packets; satisfies `ByteTwin`.

    Args:
        attitude: Motion of the body.
        profile: Scale of the counts, mounting and rate of the unit.
        imperfections: Its noise and drift.
        faults: Transmission errors of the line.
        rng: Random generator.
    """

    def __init__(
        self,
        attitude: Attitude = rocking,
        *,
        profile: ImuProfile,
        imperfections: ImuImperfections = PERFECT_UNIT,
        faults: Faults = PERFECT_LINE,
        rng: np.random.Generator,
    ) -> None:
        self.source = "sim:imu"
        self._attitude = attitude
        self._profile = profile
        self._imperfections = imperfections
        self._rng = rng
        self._wire = FaultyWire(faults, rng=rng)
        self._switched_on: float | None = None
        self._number = 0

    def poll(self, now: float, received: bytes) -> bytes:
        """Return the packets that are due; see `ByteTwin.poll`.

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
        counts = encode_orientation(self._profile, *self._measure(time))
        ticks = round(time / TICK)
        body = self._profile.body.pack(*counts)
        return encode_packet(Packet(Kind.ORIENTATION, number, ticks, body))

    def _measure(self, time: float) -> tuple[Rotation, Array, Array]:
        added = self._imperfections
        rotation = self._rotation(time)
        turned = (rotation.inv() * self._rotation(time + STEP)).as_rotvec()
        upward = rotation.inv().apply([0.0, 0.0, GRAVITY])
        error = Rotation.from_rotvec(added.angle_noise * self._rng.standard_normal(3))
        return (
            rotation * error,
            turned / STEP + added.rate_noise * self._rng.standard_normal(3),
            upward + added.force_noise * self._rng.standard_normal(3),
        )

    def _rotation(self, time: float) -> Rotation:
        roll, pitch, yaw = self._attitude(time)
        drift = self._imperfections.yaw_drift * time
        return Rotation.from_euler("ZYX", [yaw + drift, pitch, roll])
