# SPDX-License-Identifier: MIT
"""Commands to the robot: leg set-points of a gait, and stop."""

from abc import abstractmethod
from contextlib import suppress
from typing import Any, Final, Protocol

from model.gait.reference import LegReference
from rig.errors import LimitExceeded, RigError
from rig.links.byte_link import LinkedStream
from rig.zebro.profile import LegProfile, encode_counts

LONGEST_MOTION: Final = 65.535
"""Longest duration of a motion that 16 bits of milliseconds can encode [s]."""
MILLISECOND: Final = 1e-3
"""One millisecond [s]."""


class LegCommands(Protocol):
    """Commands to the robot's legs: motion to counts, and stop."""

    @property
    def profile(self) -> LegProfile:
        """Profile of the robot."""
        ...

    def set_points(self, counts: tuple[int, ...], duration: float) -> bool:
        """Send the command to turn every leg to a count, the short way round.

        Args:
            counts: Target count of each channel, in the order of the wire.
            duration: Duration of the motion [s].

        Returns:
            Whether the link took the command.

        Raises:
            LimitExceeded: The duration is negative or above `LONGEST_MOTION`.
            ProtocolError: This robot takes no commands.
            RigTimeout: The link is connected but does not take the command.
        """
        ...

    def stop(self) -> bool:
        """Send the command to stop every leg where it is; return whether the link took it.

        Raises:
            RigTimeout: The link is connected but does not take the command.
        """
        ...


class LeftStill(LinkedStream[Any]):
    """Base of leg drivers that, as context managers, stop the legs on exit if they moved them.

    Legs that were only read go on. An error of sending the stop is suppressed.
    """

    _moved = False  # set by a driver when it sends set-points

    @abstractmethod
    def stop(self) -> bool:
        """Send the command to stop every leg where it is; return whether the link took it."""

    def __exit__(self, *exception: object) -> None:
        if self._moved:
            with suppress(RigError):
                self.stop()
        super().__exit__(*exception)


def milliseconds(duration: float) -> int:
    """Convert the duration of a motion to whole milliseconds, which the protocols send.

    Args:
        duration: Duration of a motion [s].

    Returns:
        The duration, rounded [ms].

    Raises:
        LimitExceeded: The duration is negative or above `LONGEST_MOTION`.
    """
    if not 0 <= duration <= LONGEST_MOTION:
        raise LimitExceeded("duration (>= 0) of a leg motion", value=duration, limit=LONGEST_MOTION,
                            unit="s")  # fmt: skip
    return round(duration / MILLISECOND)


def follow(
    legs: LegCommands, reference: LegReference, *, start: float, now: float, horizon: float
) -> bool:
    """Send as set-points the leg angles that a gait will have at the time `now + horizon`.

    Called repeatedly, at intervals of at most `horizon`, it makes the robot walk. A leg must move
    less than half a turn within the horizon, or it would turn in the wrong direction.

    Args:
        legs: Robot whose legs are commanded.
        reference: Gait with the leg angles over time since its beginning.
        start: Host time at which the gait began [s].
        now: Host time [s].
        horizon: Time ahead at which the set-point is due, and duration of the motion to it [s].

    Returns:
        Whether the link took the command.

    Raises:
        LimitExceeded, ProtocolError, RigTimeout: As `LegCommands.set_points`.
    """
    theta = reference.angles(now - start + horizon)[0]
    chosen = [theta[leg - 1] for leg in sorted(legs.profile.legs)]
    return legs.set_points(encode_counts(legs.profile, chosen), horizon)


LEAD_IN: Final = 1.0
"""Duration of the move from the present leg angles to the first angles of the gait [s]."""
HORIZON: Final = 0.1
"""Time by which set-points are sent ahead [s]."""


class GaitPlayer:
    """Sends the set-points of a gait when they are due; call it with the host time.

    The gait's time 0 is `LEAD_IN` after the first call. If a call comes so late that the legs have
    reached their last set-point, the gait is delayed by the waiting time: a set-point farther ahead
    would make the legs jump, and beyond half a turn rotate in the wrong direction.

    Args:
        legs: Driver that sends set-points to the robot.
        gait: Leg angles over time.
        profile: Profile of the robot, with its report rate.
    """

    def __init__(self, legs: LegCommands, gait: LegReference, profile: LegProfile) -> None:
        self._legs = legs
        self._gait = gait
        gait.angles(0.0)  # loops are compiled, if they are not yet, before the robot moves
        self._start: float | None = None
        self._due = 0.0
        # At most at the robot's report rate. Without that limit twice per horizon, so that the last
        # set-point is not reached before the next is sent.
        self._interval = max(HORIZON / 2, 1 / profile.rate)

    def __call__(self, now: float) -> None:
        """Send the next set-points if they are due at host time `now` [s], none otherwise.

        The first call sends the gait's first angles, to be reached after `LEAD_IN`.
        """
        if self._start is None:
            self._start = self._due = now + LEAD_IN
            follow(self._legs, self._gait, start=self._start, now=now, horizon=LEAD_IN)
        elif now >= self._due:
            late = now - self._due
            if late > HORIZON - self._interval:
                self._start += late
            self._due = now + self._interval
            follow(self._legs, self._gait, start=self._start, now=now, horizon=HORIZON)
