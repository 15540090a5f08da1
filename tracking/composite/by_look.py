# SPDX-License-Identifier: MIT
"""Find every exposure of a robot without a marker, by how one of them looks.

Nothing in a picture says how it was merged. It is read in three ways (`mean`, `darkest`,
`pasted`), and the reading that finds most is taken; but of a mean all must be faint. Each reading finds places on a raster; they are then aligned in the photograph by
what the reading says is to be seen of each.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracking.body import Alignment, BodyTemplate, TopPlate, align, floor_in_view, make_template
from tracking.body.align import SLOW
from tracking.body.template import sample
from tracking.camera.lens import Array, Camera, CameraPose, project, to_floor
from tracking.composite.body_box import BodyBox
from tracking.composite.body_raster import BodyRaster
from tracking.composite.chain import usual_step
from tracking.composite.darkest import DarkestReading
from tracking.composite.colours import FloorColours
from tracking.composite.mean import SCALE, Fit, MeanReading
from tracking.composite.pasted import PastedReading
from tracking.composite.plane import Plane
from tracking.errors import BodyError, CompositeError
from tracking.pose import BodyPose, BodyPrior

CLOSE, WIDE = 0.05, 0.15
"""What scissors leave around a robot: along its edge, or floor and shadow too [of its length]."""

LEAST_SCORE = 0.75
"""Least correlation of what is visible of an exposure with the known one [-]."""

_CELLS = {"pasted": 40, "darkest": 32, "mean": 32}
_AROUND = 0.28  # of the length: how far sides, legs and shadow reach
_EDGE = 0.035  # of the top's length: left out where it has a pattern
_PATTERN = 0.5  # of the contrast with its edges: then it has one
_SLIP = 0.06  # of the length: an alignment that ends farther off has gone astray
_TURN = 0.15  # rad: the same
_ROUGH, _ROUGH_TURN = 0.02, np.radians(3.0)  # error of a place on the raster, of the length


@dataclass(frozen=True)
class Exposure:
    """One exposure of the robot in a composite picture.

    Attributes:
        alignment: Where it is.
        visible: Share of its top that no other hides [-].
    """

    alignment: Alignment
    visible: float


def find_exposures_like(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, known: BodyPose,
    plate: TopPlate, body_size: tuple[float, float], prior: BodyPrior,
    hidden: NDArray[np.bool_] | None = None, near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find all exposures that look like one of them.

    Args:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: The lens.
        view: Where the camera stood.
        known: Pose of one exposure; of those pasted on each other, of one that shows whole.
        plate: The robot's flat top.
        body_size: Length and width of the robot's body [m].
        prior: Height and tilt.
        hidden: Pixels that do not show the robot, as those of the floor's markers, shape
            (height, width).
        near: x and y near which to look [m]; the whole picture when None.
        reach: How far from there [m].

    Returns:
        The exposures, the known one first. Head and tail are those of the known one.

    Raises:
        CompositeError: The known exposure is cut by the picture's edge, or hardly differs from the
            floor.
    """
    none = np.zeros(pixels.shape[:2], dtype=bool)
    area = floor_in_view(camera, view, prior.height + plate.height, near, reach)
    hidden = none if hidden is None else hidden
    search = _Search(pixels, camera, view, prior, known, plate, body_size, hidden, area)
    return search.best_reading()


@dataclass(frozen=True)
class _Search:
    pixels: NDArray[np.uint8]
    camera: Camera
    view: CameraPose
    prior: BodyPrior
    known: BodyPose
    plate: TopPlate
    size: tuple[float, float]
    hidden: NDArray[np.bool_]
    area: tuple[Array, Array]

    def best_reading(self) -> tuple[Exposure, ...]:
        """Read the picture in each way; return what is found by the one that is right."""
        anchor = self.known.planar
        left, pasted = self.pasted
        darkest = self.darkest.find(anchor)
        mean = self.mean.find(anchor)
        most = max(len(pasted), len(darkest))
        if len(mean.poses) > 1 and len(mean.poses) >= most and self.mean.is_possible(mean):
            return self.aligned_in_mean(mean)
        if len(darkest) > len(pasted):
            return self.aligned_in_darkest(darkest)
        return self.aligned_in_pasted(left, pasted)

    @property
    def pasted(self) -> tuple[float, Array]:
        """What scissors left around pasted exposures, and where these are."""
        plane, picture, used, body = self.raster(self.size[0] / _CELLS["pasted"])
        ways = [
            (left, *PastedReading(plane, picture, used, body, self.box, left).find(self.known.planar))
            for left in (CLOSE, WIDE)
        ]
        left, poses, _ = max(ways, key=lambda way: way[2])
        return left, poses

    @cached_property
    def darkest(self) -> DarkestReading:
        """The picture as one of darkest values."""
        return DarkestReading(*self.raster(self.size[0] / _CELLS["darkest"]), self.size[0])

    @cached_property
    def mean(self) -> MeanReading:
        """The picture as a mean."""
        around = round(_AROUND * _CELLS["mean"])
        raster = self.raster(self.size[0] / _CELLS["mean"], around)
        return MeanReading(*raster, self.size[0], self.plate.height)

    @cached_property
    def box(self) -> BodyBox:
        """The robot's body."""
        return BodyBox(self.camera, self.view, self.size, self.plate.height, self.prior.height)

    def raster(
        self, cell: float, around: int = 0
    ) -> tuple[Plane, NDArray[np.float32], NDArray[np.bool_], BodyRaster]:
        """Lay a raster on the plane of the robot's top; what is seen there and where it counts."""
        half = 0.5 * float(np.hypot(*self.size))
        plane = Plane.over(
            self.camera, self.view, height=self.prior.height + self.plate.height,
            low=self.area[0] - half, high=self.area[1] + half, cell=cell,
        )  # fmt: skip
        widened = cv2.dilate(self.hidden.astype(np.uint8), np.ones((5, 5), np.uint8))
        edge = np.subtract(self.camera.size, 1)
        inside = ((plane.seen_px >= 0) & (plane.seen_px <= edge)).all(axis=-1)
        used = inside & (plane.read(255 * widened) < 1)
        return plane, plane.read_smooth(self.pixels), used, BodyRaster.over(self.size, cell, around)

    def body_template(self, pixels: NDArray) -> BodyTemplate:
        """Cut the body as seen from above out of the known exposure."""
        return self.template(pixels, TopPlate(*self.size, self.plate.height, 0.0, 0.0, 0.0))

    def plate_template(self, pixels: NDArray) -> BodyTemplate:
        """Cut the flat top out of the known exposure; without its edges where it has a pattern.

        What is around the top lies lower and shifts against it from one place to the next.
        """
        inside = -_EDGE * self.plate.length
        whole = self.template(pixels, self.plate)
        within = self.template(pixels, replace(self.plate, margin=inside, front_margin=inside))
        return within if within.contrast > _PATTERN * whole.contrast else whole

    def template(self, pixels: NDArray, plate: TopPlate) -> BodyTemplate:
        """Cut a part of the robot out of the known exposure."""
        try:
            return make_template(pixels, self.camera, self.view, pose=self.known, plate=plate)
        except BodyError as error:
            raise CompositeError(str(error)) from error

    def aligned_in_pasted(self, left: float, poses: Array) -> tuple[Exposure, ...]:
        """Align what no other hides of each, those on top first."""
        template = self.body_template(self.pixels)
        visible = ~self.hidden
        found = []
        for pose in poses:
            exposure = self.aligned(pose, self.pixels, template, visible=visible)
            found.append(exposure)
            visible = visible & ~self.box.hidden(exposure.alignment.pose.state, left=left)
        return tuple(found)

    def aligned_in_darkest(self, poses: Array) -> tuple[Exposure, ...]:
        """Align what is the darkest of each."""
        template, reading = self.body_template(self.pixels), self.darkest
        return tuple(
            self.aligned(
                pose, self.pixels, template,
                visible=self.on_photo(reading.shown(poses, k), reading.plane, pose) > 0.7,
            )
            for k, pose in enumerate(poses)
        )  # fmt: skip

    def aligned_in_mean(self, fit: Fit) -> tuple[Exposure, ...]:
        """Align each with what the others leave of the picture, by edges alone."""
        reading, fine = self.mean, self.fine_weighing
        weighed = self.pixels.astype(np.float32) @ fine
        weighed_again = np.linalg.inv(reading.weighing) @ fine

        def alone(k: int) -> NDArray[np.float32]:
            others = reading.sum_of(np.delete(fit.poses, k, axis=0), fit.robot)
            seen = self.on_photo(others, reading.plane, fit.poses[k])
            return (weighed - seen @ weighed_again).astype(np.float32)

        overlap = usual_step(fit.poses) < self.size[0]
        template = self.body_template(alone(0)) if overlap else self.plate_template(alone(0))
        return tuple(
            self.aligned(
                pose, alone(k), template, visible=~self.hidden, shines_through=True, least=-1.0
            )
            for k, pose in enumerate(fit.poses)
        )

    @property
    def fine_weighing(self) -> Array:
        """Matrix that makes the floor's fine pattern scatter alike in all colours, shape (3, 3).

        Lenses and JPEG spare fine colour more than fine light.
        """
        width = SLOW * self.size[0] / self.body_template(self.pixels).step
        picture = self.pixels.astype(np.float32)
        floor = FloorColours.of(picture, ~self.hidden, width=width, noise=0.5)
        return (SCALE * floor.whitening).astype(np.float32)

    def aligned(
        self, pose: Array, pixels: NDArray, template: BodyTemplate, *,
        visible: NDArray[np.bool_], shines_through: bool = False, least: float = LEAST_SCORE,
    ) -> Exposure:  # fmt: skip
        """Align one exposure; where that goes astray the place on the raster stays."""
        state = np.array([pose[0], pose[1], self.prior.height, 0.0, 0.0, pose[2]])
        top = self.box.top_seen(state)
        share = float((top & visible).sum() / max(int(top.sum()), 1))
        found = align(
            pixels, self.camera, self.view, template=template, prior=self.prior, start=pose,
            visible=visible, blurs_px=(1.0,), least_visible=0.0, least_hope=-1.0,
            shines_through=shines_through,
        )  # fmt: skip
        if found is None or self.is_astray(found, pose, least):
            return Exposure(self.rough(state), share)
        return Exposure(found, share)

    def is_astray(self, found: Alignment, pose: Array, least: float) -> bool:
        """Tell whether an alignment is too far from where it began, or too unlike the robot."""
        aligned = found.pose.planar
        turned = abs(float(np.angle(np.exp(1j * (aligned[2] - pose[2])))))
        away = float(np.hypot(*(aligned[:2] - pose[:2])))
        return found.score < least or away > _SLIP * self.size[0] or turned > _TURN

    def rough(self, state: Array) -> Alignment:
        """Take a place on the raster for the alignment."""
        slip = _ROUGH * self.size[0]
        sd = np.array([slip, slip, self.prior.height_sd, *2 * [self.prior.tilt_sd], _ROUGH_TURN])
        pose = BodyPose(state, np.diag(sd**2), np.zeros((6, 6)), 0.0, 0.0)
        return Alignment(pose, 0.0, 0.0, 0.0)

    def on_photo(self, layer: NDArray, plane: Plane, pose: Array) -> NDArray[np.float32]:
        """Read a layer of a plane at the pixels around an exposure; 0 elsewhere."""
        reach = 0.75 * float(np.hypot(*self.size))
        corners = [[x, y, plane_z] for x in (-reach, reach) for y in (-reach, reach)
                   for plane_z in (self.prior.height + self.plate.height,)]  # fmt: skip
        seen = project(self.camera, self.view, np.array(corners) + [*pose[:2], 0.0])
        low = np.clip(np.floor(seen.min(axis=0)).astype(int), 0, self.camera.size)
        high = np.clip(np.ceil(seen.max(axis=0)).astype(int) + 1, low, self.camera.size)
        u, v = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        whole = np.zeros((*self.pixels.shape[:2], *layer.shape[2:]), np.float32)
        if u.size == 0:
            return whole
        pixels = np.stack((u, v), axis=-1).reshape(-1, 2).astype(float)
        xy = to_floor(self.camera, self.view, pixels, self.prior.height + self.plate.height)
        place = np.column_stack((xy[:, 0] - plane.low[0], plane.high[1] - xy[:, 1])) / plane.cell
        values = sample(layer.astype(np.float32), place.reshape(*u.shape, 2))
        whole[low[1] : high[1], low[0] : high[0]] = values
        return whole
