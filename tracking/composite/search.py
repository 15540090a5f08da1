# SPDX-License-Identifier: MIT
"""Find every exposure of a robot in one picture into which cut-out exposures were pasted.

Exposures hide each other. Those of a robot with a marker whose marker is clearly visible are found
as in any photograph; the others by the appearance of the whole body in the clearest of them. Of a
robot without a marker the pose of one exposure is given. No exposure is accepted for its position
alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracking.body import Alignment, TopPlate, floor_in_view
from tracking.body.align import SCALE_SD
from tracking.camera.lens import Camera, CameraPose
from tracking.composite.known import Exposure, KnownExposure
from tracking.composite.order import order_exposures
from tracking.composite.pasted import PastedReading
from tracking.composite.steps import LEAST_STEP, is_apart
from tracking.detect import RobotMarker
from tracking.errors import CompositeError
from tracking.markers import Sighting, find_markers
from tracking.pose import BodyPose, BodyPrior

CLEAR_SCORE = 0.85
"""Least correlation of the marker of a fully visible exposure [-]."""

CLEAR_SPREAD = 0.03
"""Largest amount by which a fully visible exposure's correlation is below the greatest [-]."""

SHOWS_WHOLE = 0.9
"""Visible share of a body from which it must align to be an exposure [-]."""

_ADVICE = (
    "only pictures into which cut-out exposures were pasted are read: of an average or of darkest "
    "values give the photographs themselves"
)


def find_exposures(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, marker: RobotMarker,
    pose_of: Callable[[Sighting], BodyPose], prior: BodyPrior, body_size: tuple[float, float],
    hidden: NDArray[np.bool_] | None = None, near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find all exposures of a robot with a marker in one composite picture.

    Exposures whose marker correlates as `CLEAR_SCORE` and `CLEAR_SPREAD` ask are taken as found.
    Others are those found by the body's appearance that lie farther than `LEAST_STEP` from these,
    and align or are less than 0.9 visible.

    Args:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        marker: The robot's marker.
        pose_of: Function from a marker in the picture to the robot's pose.
        prior: Prior of the body's height and tilt.
        body_size: Length and width of the robot's body, by which exposures hide each other and are
            compared [m].
        hidden: True at pixels to ignore, as on the floor's markers, shape (height, width).
        near: x and y of the middle of the square in which hidden exposures are searched [m]; None
            for the whole picture.
        reach: Half the side of that square [m].

    Returns:
        The exposures, not in order of the walk: those found by the marker first, in first place
        the one of greatest correlation.

    Raises:
        CompositeError: When the marker of no exposure is clearly visible.
        FloorError: When the picture shows nothing of the marker's plane (see `floor_in_view`).
    """
    seen = find_markers(pixels, marker.dictionary, wanted=[marker.marker_id], several=True)
    marked = [
        Exposure(Alignment(pose_of(_of_open_size(each)), each.score, 0.0), 1.0)
        for each in sorted(seen, key=lambda each: -each.score)
    ]
    best = max((each.alignment.score for each in marked), default=0.0)
    least = max(CLEAR_SCORE, best - CLEAR_SPREAD)
    clear = [each for each in marked if each.alignment.score >= least]
    if not clear:
        raise CompositeError(
            "no exposure of the robot whose marker is clear is found in the composite picture; "
            f"check the marker's number and dictionary; {_ADVICE}; or annotate the robot's top in "
            "one exposure and track --without-marker"
        )
    plate = TopPlate(*body_size, marker.position[2], 0.0, 0.0, 0.0)
    others = _occluded_by(
        clear, pixels, camera, view, prior=prior, plate=plate, hidden=hidden, near=near, reach=reach
    )
    places, same = [each.planar for each in clear], LEAST_STEP * body_size[0]
    hidden_ones = [
        each
        for each in others
        if is_apart(each.planar, places, same) and (each.visible < SHOWS_WHOLE or not each.is_rough)
    ]
    return (*clear, *hidden_ones)


def _of_open_size(seen: Sighting) -> Sighting:
    """Leave the size of a marker open by `SCALE_SD`, as alignments of other exposures do.

    Else one whose print is a little larger than told would be placed differently from them.
    """
    off = (seen.corners_px - seen.corners_px.mean(axis=0)).ravel()
    return replace(seen, covariance=seen.covariance + SCALE_SD**2 * np.outer(off, off))


def _occluded_by(
    clear: Sequence[Exposure], pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *,
    prior: BodyPrior, plate: TopPlate, hidden: NDArray[np.bool_] | None, near: ArrayLike | None,
    reach: float,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find exposures, also occluded ones, by the body's appearance in a fully visible one.

    Which one lies on top is not told by its marker; where exposures were pasted in order of time,
    it is the first or the last of the walk. Of these two, or the next usable ones, that is taken
    by which the others are found with the greater sum of log odds. Empty if none is usable.
    """
    order = order_exposures(np.array([each.planar for each in clear]))
    readings: list[PastedReading] = []
    for k in dict.fromkeys((order[-1], order[0], *order)):
        try:
            reading = _reading(
                pixels, camera, view, known=clear[k].alignment.pose, plate=plate,
                body_size=(plate.length, plate.width), prior=prior, hidden=hidden, near=near,
                reach=reach,
            )  # fmt: skip
        except CompositeError:
            continue  # cut by the picture's edge, too small or too faint: try the next
        readings.append(reading)
        if len(readings) == 2:
            break
    if not readings:
        return ()
    best = max(readings, key=lambda reading: sum(each.gain for each in reading.likelier[1]))
    return best.align(best.find())


def find_exposures_like(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, known: BodyPose,
    plate: TopPlate, body_size: tuple[float, float], prior: BodyPrior,
    hidden: NDArray[np.bool_] | None = None, near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find all exposures of a composite picture, given the robot's pose in one exposure.

    Args:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        known: Pose of the robot in one exposure that no other hides.
        plate: The robot's flat top.
        body_size: Length and width of the robot's body [m].
        prior: Prior of the body's height and tilt.
        hidden: True at pixels to ignore, as on the floor's markers, shape (height, width).
        near: x and y of the middle of the square to search [m]; None for the whole picture.
        reach: Half the side of that square [m].

    Returns:
        The exposures, the known one first, the others not in order of the walk. Which end is the
        head follows from the known pose.

    Raises:
        CompositeError: The known exposure is cut by the picture's edge, too small or of too little
            contrast, or fewer than two exposures are found.
        FloorError: The picture shows nothing of the plane of the top (see `floor_in_view`).
    """
    reading = _reading(
        pixels, camera, view, known=known, plate=plate, body_size=body_size, prior=prior,
        hidden=hidden, near=near, reach=reach,
    )  # fmt: skip
    poses = reading.find()
    found = reading.align(poses) if len(poses) > 1 else ()
    if len(found) < 2:
        raise CompositeError(
            "no second exposure of the robot is found that can be aligned; annotate its top in one "
            "that is fully visible, and check the length and width of the robot's body; " + _ADVICE
        )
    return found


def _reading(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, known: BodyPose,
    plate: TopPlate, body_size: tuple[float, float], prior: BodyPrior,
    hidden: NDArray[np.bool_] | None, near: ArrayLike | None, reach: float,
) -> PastedReading:  # fmt: skip
    """Resample a picture for a known exposure.

    Raises:
        CompositeError: As `KnownExposure.body_template`.
        FloorError: As `floor_in_view`.
    """
    hidden = np.zeros(pixels.shape[:2], dtype=bool) if hidden is None else hidden
    area = floor_in_view(camera, view, prior.height + plate.height, near, reach)
    picture = KnownExposure(pixels, camera, view, prior, known, plate, body_size, hidden, area)
    picture.body_template()  # raises early if cut by an edge or too faint
    return PastedReading.of(picture)
