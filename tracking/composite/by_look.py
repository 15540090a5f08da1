# SPDX-License-Identifier: MIT
"""Find every exposure of a robot without a marker, given the pose of one exposure."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracking.body import TopPlate, floor_in_view
from tracking.camera.lens import Camera, CameraPose
from tracking.composite.darkest import DarkestReading
from tracking.composite.exposure import Exposure
from tracking.composite.known import KnownExposure
from tracking.composite.mean import MeanReading
from tracking.composite.pasted import PastedReading
from tracking.composite.reading import Merged, Reading
from tracking.errors import CompositeError
from tracking.pose import BodyPose, BodyPrior

_READINGS: dict[Merged, type[Reading]] = {
    Merged.PASTED: PastedReading, Merged.DARKEST: DarkestReading, Merged.MEAN: MeanReading,
}  # fmt: skip


def find_exposures_like(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, known: BodyPose,
    plate: TopPlate, body_size: tuple[float, float], prior: BodyPrior, merged: Merged,
    hidden: NDArray[np.bool_] | None = None, near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find all exposures of a composite picture, given the robot's pose in one exposure.

    Args:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        known: Pose of the robot in one exposure; in a pasted picture, one that no other hides.
        plate: The robot's flat top.
        body_size: Length and width of the robot's body [m].
        prior: Prior of the body's height and tilt.
        merged: How the exposures were merged.
        hidden: True at pixels to ignore, as on the floor's markers, shape (height, width).
        near: x and y of the middle of the square to search [m]; None for the whole picture.
        reach: Half the side of that square [m].

    Returns:
        The exposures, the known one first (in a picture of darkest values only if it aligns), the
        others not in order of the walk. Which end is the head follows from the known pose.

    Raises:
        CompositeError: The known exposure is cut by the picture's edge, too small or of too little
            contrast, or fewer than two exposures are found and aligned.
        ValueError: The picture shows nothing of the plane of the top (see `floor_in_view`).
    """
    hidden = np.zeros(pixels.shape[:2], dtype=bool) if hidden is None else hidden
    area = floor_in_view(camera, view, prior.height + plate.height, near, reach)
    picture = KnownExposure(pixels, camera, view, prior, known, plate, body_size, hidden, area)
    picture.body_template(pixels)  # raises early if cut by an edge or too faint
    reading = _READINGS[merged].of(picture)
    poses = reading.find()
    found = reading.align(poses) if len(poses) > 1 else ()
    if len(found) < 2:
        raise CompositeError(
            "no second exposure of the robot is found that can be aligned; annotate its top in one "
            "that is fully visible, and check the length and width of the robot's body and that "
            f"--merged {merged} is how the picture was made"
        )
    return found
