# SPDX-License-Identifier: MIT
"""Sends a robot the set-points of a gait in time: gently into it, and never by leaps."""

from typing import Final

from model.gait.reference import LegReference
from rig.zebro.commands import LegCommands, follow
from rig.zebro.profile import LegProfile

LEAD_IN: Final = 1.0
"""How long the legs take from wherever they are to where the gait begins [s]."""
HORIZON: Final = 0.1
"""How far ahead of a played gait its set-points lie [s]."""


class GaitPlayer:
    """Sends a gait's set-points whenever they are due; to be called with the host time.

    The gait's time 0 is `LEAD_IN` after the first call. Where a call comes so late that the legs
    have arrived and wait, the gait waits as long: a set-point farther ahead would make them leap,
    and beyond half a turn take the wrong way round.

    Args:
        legs: The robot.
        gait: Leg angles over time.
        profile: Profile of the robot.
    """

    def __init__(self, legs: LegCommands, gait: LegReference, profile: LegProfile) -> None:
        self._legs = legs
        self._gait = gait
        self._start: float | None = None
        self._due = 0.0
        # No faster than the robot reports, and twice within the horizon: no set-point runs out.
        self._interval = max(HORIZON / 2, 1 / profile.rate)

    def __call__(self, now: float) -> None:
        """Send the next set-point where it is due."""
        if self._start is None:
            self._start = self._due = now + LEAD_IN
            follow(self._legs, self._gait, start=self._start, now=now, horizon=LEAD_IN)
        elif now >= self._due:
            late = now - self._due
            if late > HORIZON - self._interval:
                self._start += late
            self._due = now + self._interval
            follow(self._legs, self._gait, start=self._start, now=now, horizon=HORIZON)
