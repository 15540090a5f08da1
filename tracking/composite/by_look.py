# SPDX-License-Identifier: MIT
"""Find every exposure of a robot without a marker, by how one of them looks.

Nothing in a picture says how it was merged. It is read in three ways (`mean`, `darkest`,
`pasted`), and the reading that finds most is taken; but of a mean all must be faint. Each reading
finds places on a raster; they are then aligned in the photograph by what the reading says is to be
seen of each.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracking.body import TopPlate, floor_in_view
from tracking.camera.lens import Array, Camera, CameraPose
from tracking.composite.darkest import DarkestReading
from tracking.composite.exposure import Exposure
from tracking.composite.known import LEVER, KnownExposure
from tracking.composite.mean import MeanReading
from tracking.composite.mean_alignment import exposures_in_mean
from tracking.composite.pasted import FLOOR_LEFT, LEFT, PastedReading
from tracking.errors import CompositeError
from tracking.pose import BodyPose, BodyPrior

LEAST_SCORE = 0.75
"""Least correlation of what is visible of an exposure with the known one [-]."""

MOST_ODD = 2.5
"""Points of a pasted exposure that differ by more usual differences are of something else [-]."""

PASTED_SD, DARKEST_SD = 1 / 300, 1 / 40
"""Error of a place where others show as much as the robot does, in lengths of the robot; of pasted
ones of which all shows. It grows with the root of their power, (1 - score²) / score², and was
chosen by 390 exposures of simulated walks that no test draws [-]."""

_CELLS = {"pasted": 40, "darkest": 32, "mean": 32}
_AROUND = 0.28  # of the length: how far sides, legs and shadow reach
_STRIP_LEVER = 0.9  # of the length: that much off there turns a strip
_LEAST_SHARE = 0.05


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
        CompositeError: The known exposure is cut by the picture's edge or hardly differs from the
            floor, or no other is found.
    """
    none = np.zeros(pixels.shape[:2], dtype=bool)
    area = floor_in_view(camera, view, prior.height + plate.height, near, reach)
    hidden = none if hidden is None else hidden
    picture = Likeness(pixels, camera, view, prior, known, plate, body_size, hidden, area)
    found = picture.best_reading()
    if len(found) < 2:
        raise CompositeError(
            "no exposure is found but the one whose top was marked; mark one that shows whole, "
            "and check the length and width of the robot's body"
        )
    return found


@dataclass(frozen=True)
class Likeness(KnownExposure):
    """A picture in which one exposure is known, and others are sought that look like it."""

    def best_reading(self) -> tuple[Exposure, ...]:
        """Read the picture in each way; return what is found by the one that finds most."""
        anchor = self.known.planar
        self.body_template(self.pixels)  # cut by an edge or too faint: said before the search
        reading, pasted = self.find_pasted()
        places = self.darkest.find(anchor)
        is_darkest = len(places) > len(pasted)
        # A mean, too, is darker where the robot stood: only what aligns counts against one.
        darkest = self.aligned_in_darkest(places) if is_darkest else ()
        mean = self.mean.find(anchor)
        most = max(len(pasted), len(darkest))
        if len(mean.poses) > 1 and len(mean.poses) >= most and self.mean.is_possible(mean):
            return exposures_in_mean(self, self.mean, mean)
        if is_darkest:
            return darkest
        return self.aligned_in_pasted(reading, pasted)

    def find_pasted(self) -> tuple[PastedReading, Array]:
        """Find pasted exposures, cut out closely or with floor; return how, and where they are."""
        raster, anchor = self.raster(self.size[0] / _CELLS["pasted"]), self.known.planar
        readings = [PastedReading(*raster, self.box, with_floor) for with_floor in (False, True)]
        ways = [(reading, *reading.find(anchor)) for reading in readings]
        reading, poses, _ = max(ways, key=lambda way: way[2])
        return reading, poses

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

    def aligned_in_pasted(self, reading: PastedReading, poses: Array) -> tuple[Exposure, ...]:
        """Align what no other hides of each, those on top first; else leave it on the raster."""
        template = self.body_template(self.pixels)
        visible = ~self.hidden
        found = []
        for pose in poses:
            share = self.share(pose, visible)
            alignment = self.aligned(
                pose, self.pixels, template, visible, least=LEAST_SCORE, most_odd=MOST_ODD
            )
            if alignment is None:
                exposure = Exposure(self.rough(pose), share)
            else:
                part = float(np.sqrt(max(share, _LEAST_SHARE)))
                widened = self.widened(alignment, PASTED_SD / part, lever=_STRIP_LEVER * part)
                exposure = Exposure(widened, share)
            found.append(exposure)
            visible = visible & ~self.hidden_under(exposure.alignment.pose, reading)
        return tuple(found)

    def hidden_under(self, pose: BodyPose, reading: PastedReading) -> NDArray[np.bool_]:
        """Mark the pixels that a pasted exposure hides, or may hide, shape (height, width)."""
        hidden = self.box.hidden(pose.state, left=LEFT)
        if reading.with_floor:
            floor = self.on_photo(reading.floor, reading.plane, pose.planar, reach=1.25) > 0.5
            hidden |= floor & self.box.hidden(pose.state, left=FLOOR_LEFT)
        return hidden

    def aligned_in_darkest(self, poses: Array) -> tuple[Exposure, ...]:
        """Align what is the darkest of each, twice; what does not align is none."""
        found = self.darkest_aligned(poses)
        return self.darkest_aligned(np.array([each.alignment.pose.planar for each in found]))

    def darkest_aligned(self, poses: Array) -> tuple[Exposure, ...]:
        """Align what is the darkest of each, judged by where the others are."""
        template, reading, found = self.body_template(self.pixels), self.darkest, []
        for k, pose in enumerate(poses):
            visible = self.on_photo(reading.shown(poses, k), reading.plane, pose) > 0.7
            alignment = self.aligned(pose, self.pixels, template, visible, least=LEAST_SCORE)
            if alignment is not None:
                widened = self.widened(alignment, DARKEST_SD, lever=LEVER)
                found.append(Exposure(widened, self.share(pose, visible)))
        return tuple(found)
