# SPDX-License-Identifier: MIT
"""Template of the robot: colours of its top by place in the body frame."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.annotated import AnnotatedPose
from tracking.camera.lens import Camera, CameraPose, project
from tracking.errors import BodyError
from tracking.pose import BodyPose, BodyPrior, body_to_floor

MOST_POINTS = 2500
"""Approximate largest number of points in a template; a larger top is sampled more coarsely."""


@dataclass(frozen=True)
class TopPlate:
    """The flat top of the robot, which a camera above sees without occlusion.

    Raises BodyError where length or width is not above 0.

    Attributes:
        length: Extent along the body's x [m].
        width: Extent along the body's y [m].
        height: Height over the body's origin [m].
        centre_x: x of the plate's middle in the body frame [m].
        margin: Width at the rear and sides of the plate that is added to the template, so that
            the plate's edges are inside [m].
        front_margin: Width ahead of the plate that is added to the template, where a nose may
            distinguish head from tail [m].
        centre_y: y of the plate's middle in the body frame [m].
    """

    length: float
    width: float
    height: float
    centre_x: float = 0.0
    margin: float = 0.006
    front_margin: float = 0.006
    centre_y: float = 0.0

    def __post_init__(self) -> None:
        if not (self.length > 0 and self.width > 0):
            raise BodyError(
                f"the robot's top is {self.length:g} m long and {self.width:g} m wide; expected "
                f"a length and a width above 0 m"
            )

    @property
    def corners_body(self) -> Array:
        """Corners front left, front right, rear right, rear left in the body frame, (4, 3) [m]."""
        x, y = self.length / 2, self.width / 2
        flat = np.add([[x, y], [x, -y], [-x, -y], [-x, y]], [self.centre_x, self.centre_y])
        return np.column_stack((flat, np.full(4, self.height)))

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Rear and front x, right and left y of plate with margins in the body frame [m]."""
        rear = self.centre_x - self.length / 2 - self.margin
        front = self.centre_x + self.length / 2 + self.front_margin
        side = self.width / 2 + self.margin
        return rear, front, self.centre_y - side, self.centre_y + side


@dataclass(frozen=True)
class BodyTemplate:
    """Template of the robot's top, on a raster in the body frame.

    Attributes:
        plate: The robot's top plate.
        step: Distance between neighbouring points [m].
        points_body: Points in the body frame, rows from front to rear and columns from left to
            right, as seen from above with the head up, shape (rows, columns, 3) [m].
        colours: BGR at these points, shape (rows, columns, 3) [grey levels].
        points_by: By cause of shared errors, derivative of `points_body`, shape (rows * columns, 3,
            k).
    """

    plate: TopPlate
    step: float
    points_body: Array
    colours: NDArray[np.float32]
    points_by: Mapping[str, Array] = field(default_factory=dict)

    @property
    def contrast(self) -> float:
        """Standard deviation of the colours over all points, mean of the channels [grey levels]."""
        return float(self.colours.std(axis=(0, 1)).mean())


def sample(pixels: NDArray, corners_px: Array) -> NDArray[np.float32]:
    """Interpolate a picture bilinearly at given pixel coordinates.

    Args:
        pixels: The picture, shape (height, width) or (height, width, channels).
        corners_px: Column and row of the places, shape (..., 2) [px].

    Returns:
        Values, shape (...) or (..., channels); outside the picture they fall to 0 within a pixel.
    """
    shape = corners_px.shape[:-1]
    row = corners_px.reshape(1, -1, 2).astype(np.float32)
    # cv2.remap takes at most 32767 columns, and rows of one column one by one.
    parts = [
        cv2.remap(pixels, part, None, cv2.INTER_LINEAR)  # pyright: ignore[reportCallIssue, reportArgumentType] # OpenCV's own documentation allows no second map
        for part in np.array_split(row, 1 + row.shape[1] // 30_000, axis=1)
    ]
    values = np.concatenate(parts, axis=1).astype(np.float32, copy=False)
    return values.reshape(*shape, *values.shape[2:])


def pixel_on_top(camera: Camera, view: CameraPose, *, pose: BodyPose, plate: TopPlate) -> float:
    """Compute the mean size of a photograph's pixel on the robot's top, as a square's side [m].

    Args:
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        pose: Pose of the robot.
        plate: The robot's top.
    """
    corners_px = project(camera, view, body_to_floor(plate.corners_body, pose.state))
    area = cv2.contourArea(corners_px.astype(np.float32))
    return float(np.sqrt(plate.length * plate.width / area))


def make_template(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, pose: BodyPose, plate: TopPlate,
    prior: BodyPrior | None = None,
) -> BodyTemplate:  # fmt: skip
    """Cut the robot's template out of an annotated photograph.

    Args:
        pixels: The photograph, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        pose: Pose of the robot: `tracking.pose.fit_pose` to clicks on `plate.corners_body`.
        plate: The robot's top.
        prior: Prior of height and tilt with which `pose` was fitted; None leaves out how the
            template errs with it.

    Returns:
        The template, with one point for each pixel of the photograph, or fewer.

    Raises:
        BodyError: When the plate is cut by the photograph's edge or is shorter than 16 points, or
            the standard deviation of the template's colours is below 4 grey levels.
    """
    corners = body_to_floor(plate.corners_body, pose.state)
    _refuse_cut(project(camera, view, corners), camera.size)
    rear, front, right, left = plate.extent
    most = np.sqrt((front - rear) * (left - right) / MOST_POINTS)
    step = max(pixel_on_top(camera, view, pose=pose, plate=plate), most)
    if plate.length / step < 16:
        raise BodyError(
            f"the robot's top is {plate.length / step:.0f} px long in the annotated photograph; "
            f"expected at least 16: put the camera nearer or take photographs with more pixels"
        )
    points = _grid(plate, step)
    seen = project(camera, view, body_to_floor(points.reshape(-1, 3), pose.state))
    colours = sample(pixels, seen.reshape(*points.shape[:2], 2))
    by_cause = {}
    if prior is not None:
        annotated = AnnotatedPose(camera, view, pose, prior, plate.corners_body)
        by_cause = annotated.points_by(points.reshape(-1, 3))
    template = BodyTemplate(plate, step, points, colours, points_by=by_cause)
    if template.contrast < 4.0:
        raise BodyError(
            f"the colours of the robot's top and its margin vary by {template.contrast:.1f} grey "
            f"levels (standard deviation) in the annotated photograph; expected at least 4: light "
            f"the scene better, or use a marker"
        )
    return template


def _grid(plate: TopPlate, step: float) -> Array:
    """Compute the points of a plate with margins in the body frame, (rows, columns, 3) [m].

    Rows go from front to rear, columns from left to right.
    """
    rear, front, right, left = plate.extent
    x = np.arange(front, rear, -step)
    y = np.arange(left, right, -step)
    xx, yy = np.meshgrid(x, y, indexing="ij")
    return np.stack((xx, yy, np.full_like(xx, plate.height)), axis=-1)


def _refuse_cut(corners_px: Array, size: tuple[int, int]) -> None:
    """Raise `BodyError` where a corner of the top lies outside the picture."""
    if (corners_px < 0).any() or (corners_px > np.subtract(size, 1)).any():
        raise BodyError(
            "the robot's top (in a composite picture its body) is cut by the edge of the annotated "
            "photograph; annotate the robot where it is seen whole"
        )
