# SPDX-License-Identifier: MIT
"""Clock offset between a track and its leg log, estimated from the motion."""

from collections.abc import Callable
from typing import TypeAlias

from model.errors import InsufficientData
from model.gait.inexact_log import InexactLog
from model.gait.reference import SampledReference
from model.poses import Poses
from model.robot import GRAVITY, Robot
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.slip import Slip
from model.walk_fit.tracked_walk import middle
from zebro_lab.files.errors import DataError
from zebro_lab.track.file import TrackFile
from zebro_lab.validation.shared_clock import LARGEST_OFFSET, clock_difference, estimated_clock

Legs: TypeAlias = SampledReference | InexactLog
Clock: TypeAlias = Callable[[TrackFile, Legs, Robot], TrackFile]
"""Function that shifts a track to the clock of leg angles that start at zero, or raises."""


def checked_clock(slip: Slip, *, largest: float = LARGEST_OFFSET) -> Clock:
    """Return a function that returns a track unchanged, or raises `DataError` if its clock differs.

    The offset to a path predicted from the leg angles may be up to `largest`, or three standard
    deviations if that is more. A walk of constant speed does not determine it and is accepted.

    Args:
        slip: Slip law with which the path is predicted.
        largest: Largest offset that is accepted [s].
    """

    def check(track: TrackFile, legs: Legs, robot: Robot) -> TrackFile:
        """Return the track unchanged; `DataError` if its clock differs, as said above."""
        try:
            path = _predicted_path(legs, robot, slip)
            found = clock_difference(track.poses, path, largest=largest)
        except InsufficientData:
            return track
        if found is not None:
            raise DataError(
                f"the motion shows that its clock is {found.value:+.1f} ± {found.sd:.1f} s behind "
                "the leg log's; expected one clock. Add that to its times, or let "
                "--estimate-offset do so",
                file=track.file,
            )
        return track

    return check


def estimated_clock_of(slip: Slip) -> Clock:
    """Return a clock function that estimates a track's clock offset and adds it to its times.

    The offset is estimated from the track and a path predicted from the leg angles; its variance is
    added to the track's covariance. The function raises `DataError` if the motion does not
    determine the offset.

    Args:
        slip: Slip law with which the path is predicted.
    """

    def estimate(track: TrackFile, legs: Legs, robot: Robot) -> TrackFile:
        """Return the track with the estimated offset added to its times."""
        path = _predicted_path(legs, robot, slip)
        return estimated_clock(track, path, otherwise="Add the offset to its times")[0]

    return estimate


def _predicted_path(legs: Legs, robot: Robot, slip: Slip) -> Poses:
    """Predict the path of the middle leg angles with a slip law, without a fit of walks."""
    angles = middle(legs)
    draw = WalkDraw(robot, angles, slip.traction_table(weight=robot.mass * GRAVITY))
    return planar_walk(draw, duration=float(legs.t[-1])).poses
