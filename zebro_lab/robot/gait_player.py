# SPDX-License-Identifier: MIT
"""Send a robot the leg set-points of a gait in real time, with a smooth lead-in."""

from typing import Final

from model.gait.reference import LegReference
from rig.zebro.commands import LegCommands, follow
from rig.zebro.profile import LegProfile

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
