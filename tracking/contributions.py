# SPDX-License-Identifier: MIT
"""Which errors make a track uncertain: how much its variance would fall were a cause known."""

from dataclasses import dataclass

import numpy as np

from model.arrays import Array
from tracking.path import Track
from tracking.shared import (
    ANNOTATION,
    EDGES,
    HEIGHT,
    LENS,
    MARKS,
    PLACE,
    SIDE,
    STANDS,
    TILT,
    TURN,
    family_of,
)

ADVICE = {
    LENS: "photograph the calibration board more often, also near the picture's edges and tilted",
    STANDS: "lay out more floor markers, around the walk and larger",
    MARKS: "measure the floor's marks with a better tape, and state position_sd in floor.toml",
    EDGES: "print larger markers, move the camera closer, and switch off sharpening",
    SIDE: "measure the side of the robot's marker with callipers, and state marker.side_sd",
    PLACE: "measure where the marker is on the body, and state marker.position_sd",
    TURN: "measure how the marker is turned on the body, and state marker.yaw_sd_deg",
    HEIGHT: "measure how high the body is while the robot walks, and state --body-height and "
    "--mean-height-sd",
    TILT: "mount the marker level, near the body's centre",
    ANNOTATION: "annotate the robot in another photograph too, or click its corners more exactly "
    "and state corner_sd_px",
}
"""By cause, what to do for a track of smaller uncertainty."""


@dataclass(frozen=True)
class Contribution:
    """How much of a track's variance goes if one cause of errors were known, the others free.

    Such parts need not add up to 1: of two causes that cannot be told apart each gives little.

    Attributes:
        cause: Name of the cause (`tracking.shared`).
        position: Part of the mean variance of x and y [-].
        yaw: Part of the mean variance of yaw [-].
    """

    cause: str
    position: float
    yaw: float

    @property
    def advice(self) -> str:
        """What to do for a smaller uncertainty of this cause."""
        return ADVICE[self.cause]


def contributions(track: Track) -> tuple[Contribution, ...]:
    """Compute what each cause of shared errors contributes, that with the largest part first.

    All stands of the camera are one cause, as are all marks of the floor.

    Args:
        track: The track.
    """
    whole = _variances(track.covariance)
    members: dict[str, list[str]] = {}
    for cause in track.shared.slots:
        members.setdefault(family_of(cause), []).append(cause)
    found = []
    for family, causes in members.items():
        position, yaw = 1 - _variances(track.covariance_given(causes)) / whole
        found.append(Contribution(family, float(position), float(yaw)))
    return tuple(sorted(found, key=lambda each: -max(each.position, each.yaw)))


def shared_part(track: Track) -> tuple[float, float]:
    """Compute which part of the variance all shared errors make together; the rest averages out.

    Args:
        track: The track.

    Returns:
        Part of the mean variance of x and y, and of yaw [-].
    """
    known = _variances(track.covariance_given(list(track.shared.slots)))
    position, yaw = 1 - known / _variances(track.covariance)
    return float(position), float(yaw)


def _variances(covariance: Array) -> Array:
    """Compute the mean over poses of the variances of x plus y, and of yaw, shape (2,)."""
    diagonal = np.diagonal(covariance, axis1=1, axis2=2).mean(axis=0)
    return np.array([diagonal[0] + diagonal[1], diagonal[2]])
