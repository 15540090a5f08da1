# SPDX-License-Identifier: MIT
"""Exposures of a composite picture; the one of known pose is the reference to align others."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body import (
    Alignment,
    BodyTemplate,
    TopPlate,
    align,
    make_template,
)
from tracking.body.plane import Plane
from tracking.body.template import sample
from tracking.camera.lens import Camera, CameraPose, project, to_floor
from tracking.composite.body_box import BodyBox
from tracking.errors import BodyError, CompositeError
from tracking.pose import HELD, BodyPose, BodyPrior

LEAST_SCORE = 0.75
"""Least correlation of an exposure's visible part with the template of the known exposure [-]."""

LEVER = 0.7
"""Lever arm that converts an error of position to one of heading, in lengths of the robot [-]."""

RASTER_SD = 0.02
"""Standard deviation of x and of y of a pose found on the raster, in lengths of the robot [-]."""

PASTED_SD = 1 / 300
"""Standard deviation of position, in lengths of the robot, of a fully visible exposure where other
things are as strong as the robot [-].

It is proportional to the root of their power, (1 - score²) / score², over that of the visible
share. It was calibrated on simulated walks that no test uses."""

STRIP_SD = 1.25e-4
"""Standard deviation of position, in lengths of the robot, of an exposure of which half is visible,
since a strip alone hardly says where along the robot's top it lies [-].

It is proportional to the square of the hidden over the visible share. Of 26 exposures with less
than a quarter visible, on 14 simulated walks that no test uses, 90 % intervals held 62 % of x and
81 % of y without it (errors of one walk are alike, up to 2.5 mm), and hold 77 and 88 % with it; of
all 96 exposures half a body apart they hold 92 and 93 %."""

_LEAST_SHARE = 0.05  # visible: less is taken as this

_DIVERGED = 0.06  # of the length: an alignment that moves farther has diverged
_DIVERGED_TURN = 0.15  # rad: the same


@dataclass(frozen=True)
class Exposure:
    """One exposure of the robot in a composite picture.

    Attributes:
        alignment: Pose of the robot in the exposure, with covariances and score.
        visible: Share of the robot's top that no other exposure hides, 0 to 1; always 1 of
            exposures found by the robot's marker [-].
    """

    alignment: Alignment
    visible: float

    @property
    def planar(self) -> Array:
        """x, y [m] and yaw [rad] of the robot, shape (3,)."""
        return self.alignment.pose.planar

    @property
    def is_rough(self) -> bool:
        """Whether alignment failed, so that the pose is that found on the coarse raster."""
        return self.alignment.score == 0.0


@dataclass(frozen=True)
class KnownExposure:
    """A composite picture in which the pose of one exposure is known.

    Attributes:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        prior: Prior of the body's height and tilt.
        pose: Pose of the robot in the known exposure.
        plate: The robot's flat top.
        size: Length and width of the robot's body [m].
        hidden: True at pixels to ignore, as on the floor's markers, shape (height, width).
        area: Lowest and highest x, y at which the body's middle is searched, shape (2,) each [m].
    """

    pixels: NDArray[np.uint8]
    camera: Camera
    view: CameraPose
    prior: BodyPrior
    pose: BodyPose
    plate: TopPlate
    size: tuple[float, float]
    hidden: NDArray[np.bool_]
    area: tuple[Array, Array]

    @cached_property
    def box(self) -> BodyBox:
        """Box around the robot's body, to compute what it occludes."""
        return BodyBox(self.camera, self.view, self.size, self.plate.height, self.prior.height)

    @property
    def body_plate(self) -> TopPlate:
        """Plate of the body's size at the height of the top, about its origin, without margins."""
        return TopPlate(*self.size, self.plate.height, 0.0, 0.0, 0.0)

    def body_template(self) -> BodyTemplate:
        """Cut the template of the whole body (`body_plate`) out of the known exposure.

        Raises:
            CompositeError: The body is cut by the picture's edge, too small or of too little
                contrast (`make_template`).
        """
        try:
            return make_template(
                self.pixels, self.camera, self.view, pose=self.pose, plate=self.body_plate,
                prior=self.prior,
            )  # fmt: skip
        except BodyError as error:
            raise CompositeError(str(error)) from error

    def share(self, pose: Array, visible: NDArray[np.bool_]) -> float:
        """Compute the share of the pixels of an exposure's top that are visible, 0 to 1 [-].

        It is 0 where the top lies outside the picture.

        Args:
            pose: x, y [m] and yaw [rad] of the exposure, shape (3,).
            visible: True at visible pixels, shape (height, width).
        """
        top = self.box.top_seen(self.level(pose))
        return float((top & visible).sum() / max(int(top.sum()), 1))

    def level(self, pose: Array) -> Array:
        """Return x, y, z, roll, pitch, yaw (6,) of a level robot at the prior's height.

        Args:
            pose: x, y [m] and yaw [rad], shape (3,).
        """
        return np.array([pose[0], pose[1], self.prior.height, 0.0, 0.0, pose[2]])

    def aligned(
        self, pose: Array, template: BodyTemplate, visible: NDArray[np.bool_], *,
        least: float, outlier_sd: float = np.inf,
    ) -> Alignment | None:  # fmt: skip
        """Align one exposure with a template.

        Args:
            pose: Pose to start from: x, y [m] and yaw [rad], shape (3,).
            template: Template of the robot.
            visible: True at pixels to use, shape (height, width).
            least: Least correlation to accept [-].
            outlier_sd: Standard deviations beyond which a point is left out as an outlier [-].

        Returns:
            The alignment, or None where the robot leaves the picture, fewer than 60 points are
            visible, or it diverges (`has_diverged`).
        """
        found = align(
            self.pixels, self.camera, self.view, template=template, prior=self.prior, start=pose,
            visible=visible, blurs_px=(1.0,), least_visible=0.0, least_hope=-1.0,
            outlier_sd=outlier_sd,
        )  # fmt: skip
        return None if found is None or self.has_diverged(found, pose, least) else found

    def has_diverged(self, found: Alignment, pose: Array, least: float) -> bool:
        """Return whether an alignment has too small a score or ends too far from its start.

        Too far is 0.06 lengths of the robot or 0.15 rad.

        Args:
            found: The alignment.
            pose: Pose it started from: x, y [m] and yaw [rad], shape (3,).
            least: Least correlation to accept [-].
        """
        aligned = found.pose.planar
        turned = abs(float(np.angle(np.exp(1j * (aligned[2] - pose[2])))))
        away = float(np.hypot(*(aligned[:2] - pose[:2])))
        return found.score < least or away > _DIVERGED * self.size[0] or turned > _DIVERGED_TURN

    def rough(self, pose: Array) -> Alignment:
        """Build an alignment of score 0 from a pose (3,) on the raster, with the raster's error.

        The robot is level at the prior's height, both with the prior's standard deviations.
        """
        covariance = np.zeros((6, 6))
        covariance[np.ix_(HELD, HELD)] = self.prior.covariance
        level = BodyPose(self.level(pose), covariance)
        return widened(Alignment(level, 0.0, 0.0), RASTER_SD * self.size[0], RASTER_SD / LEVER)

    def on_photo(
        self, layer: NDArray, plane: Plane, pose: Array, *, reach: float = 0.75
    ) -> NDArray[np.float32]:
        """Interpolate values on a plane at the photograph's pixels around an exposure.

        Args:
            layer: Values on the plane's raster, shape (rows, columns, ...).
            plane: Raster of the plane of the robot's top.
            pose: x, y [m] and yaw [rad] of the exposure, shape (3,).
            reach: Half the side of the region to fill, in diagonals of the body [-].

        Returns:
            Values, shape (height, width, ...); 0 outside the region and outside the plane.
        """
        whole = np.zeros((*self.pixels.shape[:2], *layer.shape[2:]), np.float32)
        window, xy = self.around(pose, reach=reach)
        place = np.stack((xy[..., 0] - plane.low[0], plane.high[1] - xy[..., 1]), axis=-1)
        if place.size:
            whole[window] = sample(layer.astype(np.float32), place / plane.cell)
        return whole

    def around(self, pose: Array, *, reach: float) -> tuple[tuple[slice, slice], Array]:
        """Compute the window of pixels around an exposure, and their x, y on the top's plane.

        Args:
            pose: x, y [m] and yaw [rad] of the exposure, shape (3,).
            reach: Half the side of the square that the window shows, in diagonals of the body [-].

        Returns:
            Slices of rows and columns, and x, y of each pixel on the plane at the height of the
            robot's top, shape (rows, columns, 2) [m].
        """
        reach *= float(np.hypot(*self.size))
        height = self.prior.height + self.plate.height
        sides = np.array([-reach, reach])
        around = [[pose[0] + dx, pose[1] + dy, height] for dx in sides for dy in sides]
        seen = project(self.camera, self.view, np.array(around))
        low = np.clip(np.floor(seen.min(axis=0)).astype(int), 0, self.camera.size)
        high = np.clip(np.ceil(seen.max(axis=0)).astype(int) + 1, low, self.camera.size)
        u, v = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        pixels = np.stack((u, v), axis=-1).reshape(-1, 2).astype(float)
        xy = to_floor(self.camera, self.view, pixels, height).reshape(*u.shape, 2)
        return (slice(low[1], high[1]), slice(low[0], high[0])), xy


def disturbance_sd(score: float, share: float) -> float:
    """Compute the standard deviation of x and y by other exposures and the floor, in robot lengths.

    It is `PASTED_SD` times the root of (1 - score²) / score² over the share, of at least 0.05.

    Args:
        score: Correlation of the exposure's visible part with the template, above 0 [-].
        share: Visible share of the top [-].
    """
    power = max(1 - score**2, 0.0) / score**2
    return float(PASTED_SD * np.sqrt(power / max(share, _LEAST_SHARE)))


def strip_sd(share: float) -> float:
    """Compute the standard deviation of x and y of an exposure seen as a strip, in robot lengths.

    It is `STRIP_SD` times the square of the hidden over the visible share, this of at least 0.05.

    Args:
        share: Visible share of the top [-].
    """
    return STRIP_SD * (1 / max(share, _LEAST_SHARE) - 1) ** 2


def widened(alignment: Alignment, position: float, turn: float) -> Alignment:
    """Add independent errors to x and y, and to yaw, by their standard deviations [m, rad]."""
    added = np.diag([position, position, 0.0, 0.0, 0.0, turn]) ** 2
    pose = replace(alignment.pose, covariance=alignment.pose.covariance + added)
    return replace(alignment, pose=pose)
