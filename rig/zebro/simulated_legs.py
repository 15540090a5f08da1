# SPDX-License-Identifier: MIT
"""Six simulated legs that follow a gait and give their angles as counts, without a protocol.

Not modelled: motor dynamics and load, drift of the robot's clock other than a constant rate error.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from model.arrays import Array
from model.gait.reference import LegReference
from rig.errors import ProtocolError
from rig.zebro.profile import LegProfile, encode_counts

FASTER: Final = 1.2
"""A leg that speeds up by this factor from one frame to the next begins its swing."""


@dataclass(frozen=True)
class RobotImperfections:
    """Deviations of the robot from its gait; the defaults follow it exactly.

    Attributes:
        jitter: Standard deviation of the time of a frame; its error is clipped to 0.45 periods [s].
        pause_probability: Probability that the robot pauses before a leg begins its swing.
        pause: Duration of a pause [s].
        clock_rate_error: Relative error of the robot's clock, above 0 where it runs fast [-].

    Raises:
        ProtocolError: `jitter` or `pause` is negative, or `pause_probability` not from 0 to 1.
    """

    jitter: float = 0.0
    pause_probability: float = 0.0
    pause: float = 0.2
    clock_rate_error: float = 0.0

    def __post_init__(self) -> None:
        if not (self.jitter >= 0 and self.pause >= 0 and 0 <= self.pause_probability <= 1):
            raise ProtocolError(
                f"jitter is {self.jitter:g} s, pause {self.pause:g} s with probability "
                f"{self.pause_probability:g}; expected at least 0 s, and a probability, 0 to 1"
            )


EXACT_ROBOT = RobotImperfections()
"""A robot that follows its gait exactly."""


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
        imperfections: Deviations from the gait.
        rng: Random generator.
    """

    def __init__(
        self,
        reference: LegReference,
        *,
        profile: LegProfile,
        imperfections: RobotImperfections = EXACT_ROBOT,
        rng: np.random.Generator,
    ) -> None:
        self.profile = profile
        self._reference = reference
        self._imperfections = imperfections
        self._rng = rng
        self._switched_on: float | None = None
        self._number = 0
        self._behind = 0.0
        self._paused_until = 0.0
        self._speeds = reference.speeds(0.0)[0]
        self._motion: tuple[float, float, Array, Array] | None = None

    def frames(self, now: float) -> list[Frame]:
        """Return the frames that are due since the last call, one every 1/rate.

        Args:
            now: Time by the caller's clock [s].

        Returns:
            The frames in order; the first call switches the robot on and returns frame 0.
        """
        time = self._since_start(now)
        due = int(np.floor(time * self.profile.rate + 1e-9)) + 1
        frames = [self._frame(number) for number in range(self._number, due)]
        self._number = due
        return frames

    def restart(self) -> None:
        """Restart as after a loss of power: numbers, time and gait begin at 0.

        Legs that were commanded stand at the target of the last command.
        """
        self._switched_on = None
        self._number = 0
        self._behind = self._paused_until = 0.0
        if self._motion is not None:
            self._motion = (0.0, 0.0, *self._motion[2:])

    def angles(self, time: float) -> Array:
        """Compute the true leg angles of the gait, or of the last command, shape (6,) [rad].

        The gait is late by the pauses so far.

        Args:
            time: Time since the robot was switched on [s].
        """
        if self._motion is not None:
            start, duration, origin, target = self._motion
            share = 1.0 if duration <= 0 else min(max((time - start) / duration, 0.0), 1.0)
            return origin + share * (target - origin)
        return self._reference.angles(max(time - self._behind, 0.0))[0]

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
        if self._switched_on is None:
            self._switched_on = now
        return now - self._switched_on

    def _frame(self, number: int) -> Frame:
        half = 0.45 / self.profile.rate
        jitter = self._imperfections.jitter * self._rng.standard_normal()
        time = number / self.profile.rate + float(np.clip(jitter, -half, half))
        self._pause(time)
        theta = self.angles(time)
        by_leg = [theta[leg - 1] for leg in sorted(self.profile.legs)]
        device_time = max(time, 0.0) * (1 + self._imperfections.clock_rate_error)
        return Frame(number, device_time, time, encode_counts(self.profile, by_leg))

    def _pause(self, time: float) -> None:
        """Start or continue a random pause of the gait at the time of a frame [s].

        A pause starts with the probability `pause_probability` when a leg begins its swing.
        """
        if self._imperfections.pause_probability == 0:
            return
        if time < self._paused_until:
            self._behind += 1 / self.profile.rate
            return
        speeds = self._reference.speeds(max(time - self._behind, 0.0))[0]
        begins = bool(np.any(speeds > FASTER * np.maximum(self._speeds, 1e-9)))
        self._speeds = speeds
        if begins and self._rng.random() < self._imperfections.pause_probability:
            self._paused_until = time + self._imperfections.pause
