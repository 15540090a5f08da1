# SPDX-License-Identifier: MIT
"""Derive the robot for tracking from `robot.toml`: marker, and prior on the body's height."""

import numpy as np

from tracking.detect import MarkedRobot
from tracking.errors import TrackingError
from tracking.pose import BodyPrior, RobotMarker
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.marker_numbers import require_in_dictionary
from zebro_lab.robot.robot_file import RobotFile

WALKING_TILT_SD = 0.02
"""Standard deviation of roll and of pitch, both of their means and about these [rad]."""

STEEPEST = 0.05
"""Roll or pitch beyond which a marker on the robot is not level [rad]."""


def tracked_robot(described: RobotFile, *, prior: BodyPrior) -> MarkedRobot:
    """Return the robot with its marker from `robot.toml`.

    In `robot.toml` the marker's x axis is the print's upward direction: a print whose top points
    ahead has yaw 0.

    Args:
        described: Content of `robot.toml`.
        prior: Prior on height and tilt of the body.

    Raises:
        SettingsError: The marker's place is missing or not level, or the marker is invalid: of
            another form, not in its dictionary, or of an impossible size.
    """
    place = described.marker
    if place is None:
        raise SettingsError(
            "missing; state the marker's place on the robot (docs/formats.md), or track it "
            "--without-marker",
            file=_file(described), key="marker",
        )  # fmt: skip
    roll, pitch, yaw = place.roll_pitch_yaw
    if max(abs(roll), abs(pitch)) > STEEPEST:
        raise SettingsError(
            f"roll {np.degrees(roll):.2f} and pitch {np.degrees(pitch):.2f} degrees; a marker on "
            f"the robot must lie within {np.degrees(STEEPEST):.2f} degrees of level in both",
            file=described.file, key="marker.roll_pitch_yaw_deg",
        )  # fmt: skip
    printed = place.printed
    try:
        require_in_dictionary(printed.dictionary, [printed.number])
        on_robot = RobotMarker(
            printed.number, printed.side, printed.dictionary, place.position, yaw=yaw - np.pi / 2,
            side_sd=place.side_sd, position_sd=place.position_sd, yaw_sd=place.yaw_sd,
        )  # fmt: skip
    except TrackingError as error:
        raise SettingsError(str(error), file=_file(described), key="marker") from error
    return MarkedRobot(on_robot, prior)


def body_prior(
    described: RobotFile, *, height: float | None, mean_height_sd: float, height_sd: float
) -> BodyPrior:
    """Return the prior on the body's height, from a given height or from the marker's.

    Args:
        described: Content of `robot.toml`.
        height: Mean height of the body's origin over a walk [m]; None for that at which the robot
            stands, by its marker.
        mean_height_sd: Standard deviation of that mean [m].
        height_sd: Standard deviation of the height about its mean [m].

    Raises:
        SettingsError: The height is not known, or a standard deviation is not positive.
    """
    for sd, key in ((height_sd, "--height-sd"), (mean_height_sd, "--mean-height-sd")):
        if not sd > 0:
            raise SettingsError(f"is {sd:g} m; expected more than 0", key=key)
    if height is None:
        height = _standing_height(described)
    return BodyPrior(
        height, height_sd, mean_height_sd=mean_height_sd, tilt_sd=WALKING_TILT_SD,
        mean_tilt_sd=WALKING_TILT_SD,
    )  # fmt: skip


def _standing_height(described: RobotFile) -> float:
    """Compute how high the body's origin is while the robot stands, by its marker [m]."""
    place = described.marker
    if place is None or place.height is None:
        raise SettingsError(
            "missing; measure how high the marker is above the floor while the robot stands, or "
            "give --body-height",
            file=_file(described), key="marker.height",
        )  # fmt: skip
    return place.height - place.position[2]


def _file(described: RobotFile) -> str:
    return str(described.file or "the thesis's robot (choose another with --robot)")
