# SPDX-License-Identifier: MIT
"""Six simulated legs that follow a gait and give their angles as counts, without a protocol.

Not modelled: motor dynamics and load, jitter, errors of the robot's clock.
"""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from model.gait.reference import LegReference
from rig.zebro.profile import LegProfile, encode_counts


@dataclass(frozen=True)
class Frame:
    """Leg counts that the robot reports at one instant.

    Attributes:
        number: Number of the frame, from 0.
        device_time: Time of the reading by the robot's clock [s].
        time: True time of the reading since the robot was switched on [s].
        counts: Count of each channel, in the order of the wire.
    """

    number: int
    device_time: float
    time: float
    counts: tuple[int, ...]


class SimulatedLegs:
    """Six legs that follow a gait until they are commanded otherwise.

    Args:
        reference: Gait that the legs follow until they are commanded.
        profile: Conversion of angles to counts; a driver may be given another one on purpose.
    """

    def __init__(
        self,
        reference: LegReference,
        *,
        profile: LegProfile,
    ) -> None:
        self.profile = profile
        self._reference = reference
        self._switched_on: float | None = None
        self._number = 0
        # Last command: start and duration since switched on [s], first and last angles [rad]
        self._motion: tuple[float, float, Array, Array] | None = None

    def frames(self, now: float) -> list[Frame]:
        """Return the frames that are due since the last call, one every 1/rate.

        Args:
            now: Time by the caller's clock [s].

        Returns:
            The frames in order; the first call switches the robot on and returns frame 0.
        """
        time = self._since_start(now)
        due = int(np.floor(time * self.profile.rate + 1e-9)) + 1  # despite rounding errors
        frames = [self._frame(number) for number in range(self._number, due)]
        self._number = due
        return frames

    def restart(self) -> None:
        """Restart as after a loss of power: numbers, time and gait begin at 0.

        Legs that were commanded stand at the target of the last command.
        """
        self._switched_on = None
        self._number = 0
        if self._motion is not None:
            self._motion = (0.0, 0.0, *self._motion[2:])

    def angles(self, time: float) -> Array:
        """Compute the true leg angles of the gait, or of the last command, shape (6,) [rad].

        Args:
            time: Time since the robot was switched on [s].
        """
        if self._motion is not None:
            start, duration, origin, target = self._motion
            share = 1.0 if duration <= 0 else min(max((time - start) / duration, 0.0), 1.0)
            return origin + share * (target - origin)
        return self._reference.angles(max(time, 0.0))[0]

    def angles_at(self, now: float) -> Array:
        """Compute the true leg angles at `now` by the caller's clock [s], shape (6,) [rad].

        The first call of this function or of `frames` switches the robot on.
        """
        return self.angles(self._since_start(now))

    def command(self, counts: tuple[int, ...], duration: float, now: float) -> None:
        """Turn every leg to a count the short way round, at constant speed, and hold it there.

        Legs without a channel stay where they are.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].
            now: Time by the caller's clock [s].
        """
        time = self._since_start(now)
        origin = self.angles(time)
        target = origin.copy()
        for channel, leg in enumerate(self.profile.legs):
            turn = 2 * np.pi / self.profile.counts_per_revolution
            goal = (counts[channel] - self.profile.zero_counts[channel]) * turn
            goal *= self.profile.sign[channel]
            target[leg - 1] += np.remainder(goal - origin[leg - 1] + np.pi, 2 * np.pi) - np.pi
        self._motion = (time, duration, origin, target)

    def stop(self, now: float) -> None:
        """Hold every leg at its angle at `now`, time by the caller's clock [s]."""
        time = self._since_start(now)
        here = self.angles(time)
        self._motion = (time, 0.0, here, here)

    def _since_start(self, now: float) -> float:
        """Return the time since the robot was switched on, which the first call does [s]."""
        if self._switched_on is None:
            self._switched_on = now
        return now - self._switched_on

    def _frame(self, number: int) -> Frame:
        """Build a frame with the true leg angles at its time, rounded to counts."""
        time = number / self.profile.rate
        theta = self.angles(time)
        by_leg = [theta[leg - 1] for leg in sorted(self.profile.legs)]
        return Frame(number, time, time, encode_counts(self.profile, by_leg))
