# SPDX-License-Identifier: MIT
"""Find the exposures of a picture of darkest values, and align the part where each is darkest."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tracking.camera.lens import Array
from tracking.composite.darkest import DarkestSearch
from tracking.composite.exposure import Exposure
from tracking.composite.known import LEAST_SCORE, LEVER, KnownExposure

DARKEST_SD = 1 / 40
"""Error of position, as `tracking.composite.pasted_alignment.PASTED_SD` [-]."""

_CELLS = 32  # points of the raster along the robot
_SHOWN = 0.7  # share of a pixel's surroundings that must show the exposure


@dataclass(frozen=True)
class DarkestReading:
    """A picture that holds, of each pixel, the darkest value of all exposures.

    Attributes:
        picture: The picture and the known exposure.
    """

    picture: KnownExposure

    @cached_property
    def search(self) -> DarkestSearch:
        """The picture on a raster."""
        length = self.picture.size[0]
        return DarkestSearch(*self.picture.raster(length / _CELLS), length)

    def find(self) -> Array:
        """Find all exposures, the known one first, shape (n, 3)."""
        return self.search.find(self.picture.known.planar)

    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align the part where each exposure is the darkest, twice; drop what does not align."""
        found = self.aligned_among(poses)
        return self.aligned_among(np.array([each.alignment.pose.planar for each in found]))

    def aligned_among(self, poses: Array) -> tuple[Exposure, ...]:
        """Align the part where each is the darkest, given the poses of the others."""
        picture, search, found = self.picture, self.search, []
        template = picture.body_template(picture.pixels)
        for k, pose in enumerate(poses):
            visible = picture.on_photo(search.shown(poses, k), search.plane, pose) > _SHOWN
            alignment = picture.aligned(pose, picture.pixels, template, visible, least=LEAST_SCORE)
            if alignment is not None:
                widened = picture.widened(alignment, DARKEST_SD, lever=LEVER)
                found.append(Exposure(widened, picture.share(pose, visible)))
        return tuple(found)
