# SPDX-License-Identifier: MIT
"""Whether a walk's track keeps the clock of its leg log, by the motion that the legs make."""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from model.bayes.walks.misfit import middle
from model.errors import InsufficientData
from model.gait.quantised import QuantisedLog
from model.gait.reference import SampledReference
from model.metrics.clock import estimate_offset
from model.poses import Poses
from model.robot import GRAVITY, Robot
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.slip import Slip
from zebro_lab.files.errors import DataError
from zebro_lab.track.file import TrackFile
from zebro_lab.validation.shared_clock import estimated_clock

OFF = 0.5  # s, and three standard deviations; legs that are off look like a few tenths

Legs: TypeAlias = SampledReference | QuantisedLog
Clock: TypeAlias = Callable[[TrackFile, Legs, Robot], TrackFile]
"""Brings a track to the clock of leg angles that start at zero, or refuses it."""


def checked_clock(slip: Slip) -> Clock:
    """Refuse a track whose clock the motion says is another; an even walk says nothing.

    Args:
        slip: The rig's calibration, by which the legs are walked.
    """

    def check(track: TrackFile, legs: Legs, robot: Robot) -> TrackFile:
        try:
            found = estimate_offset(track.poses, _walked(legs, robot, slip))
        except InsufficientData:
            return track
        if abs(found.value) > max(OFF, 3 * found.sd):
            raise DataError(
                f"the motion says that its clock is {found.value:+.1f} ± {found.sd:.1f} s behind "
                "the leg log's; expected one clock. Add that to its times, or let "
                "--estimate-offset do so",
                file=track.file,
            )
        return track

    return check


def estimated_clock_of(slip: Slip) -> Clock:
    """Find in the motion what has to be added to a track's times, and add it.

    Args:
        slip: The rig's calibration, by which the legs are walked.
    """

    def estimate(track: TrackFile, legs: Legs, robot: Robot) -> TrackFile:
        path = _walked(legs, robot, slip)
        return estimated_clock(track, path, otherwise="Add the offset to its times").track

    return estimate


def since(track: TrackFile, start: float) -> TrackFile:
    """Shift a track's times so that they count from `start`.

    Args:
        track: Tracked poses.
        start: Time of the new origin, in the track's present time base [s].
    """
    return replace(track, poses=track.poses.delayed(-start))


def _walked(legs: Legs, robot: Robot, slip: Slip) -> Poses:
    angles = middle(legs)
    draw = WalkDraw(robot, angles, slip.traction_table(weight=robot.mass * GRAVITY))
    return planar_walk(draw, duration=float(legs.t[-1])).poses
