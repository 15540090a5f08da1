# SPDX-License-Identifier: MIT
"""Find the exposures of a picture of pasted robots, and align the visible part of each."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracking.camera.lens import Array
from tracking.composite.exposure import Exposure
from tracking.composite.known import LEAST_SCORE, KnownExposure
from tracking.composite.pasted import FLOOR_LEFT, LEFT, PastedSearch
from tracking.pose import BodyPose

MOST_ODD = 2.5
"""Standard deviations beyond which a point of a pasted exposure is an outlier [-]."""

PASTED_SD = 1 / 300
"""Standard deviation of position, in lengths of the robot, of a fully visible exposure where other
things are as strong as the robot [-].

It is proportional to the root of their power, (1 - score²) / score². It was calibrated on simulated
walks that no test uses."""

_CELLS = 40  # points of the raster along the robot
_STRIP_LEVER = 0.9  # lever arm for the heading of a strip, of the length
_LEAST_SHARE = 0.05


@dataclass(frozen=True)
class PastedReading:
    """Reading of a picture of exposures that were cut out and pasted on each other.

    Attributes:
        picture: The picture and the known exposure, which shows whole.
    """

    picture: KnownExposure

    @cached_property
    def found(self) -> tuple[PastedSearch, Array]:
        """The likelier of two searches, robots cut out closely or with floor, and its poses."""
        raster = self.picture.raster(self.picture.size[0] / _CELLS)
        searches = [
            PastedSearch(*raster, self.picture.box, with_floor) for with_floor in (False, True)
        ]
        ways = [(search, *search.find(self.picture.known.planar)) for search in searches]
        search, poses, _ = max(ways, key=lambda way: way[2])
        return search, poses

    def find(self) -> Array:
        """Find all exposures, the known one first and those on top before those under them."""
        return self.found[1]

    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align the visible part of each, those on top first; keep the raster's pose on failure."""
        picture, found = self.picture, []
        template, visible = picture.body_template(picture.pixels), ~picture.hidden
        for pose in poses:
            share = picture.share(pose, visible)
            alignment = picture.aligned(
                pose, picture.pixels, template, visible, least=LEAST_SCORE, most_odd=MOST_ODD
            )
            if alignment is None:
                exposure = Exposure(picture.rough(pose), share)
            else:
                part = float(np.sqrt(max(share, _LEAST_SHARE)))
                widened = picture.widened(alignment, PASTED_SD / part, lever=_STRIP_LEVER * part)
                exposure = Exposure(widened, share)
            found.append(exposure)
            visible = visible & ~self.hidden_under(exposure.alignment.pose)
        return tuple(found)

    def hidden_under(self, pose: BodyPose) -> NDArray[np.bool_]:
        """Compute the mask of pixels that an exposure hides, or may hide, (height, width)."""
        picture, search = self.picture, self.found[0]
        hidden = picture.box.hidden(pose.state, left=LEFT)
        if search.with_floor:
            floor = picture.on_photo(search.floor, search.plane, pose.planar, reach=1.25) > 0.5
            hidden |= floor & picture.box.hidden(pose.state, left=FLOOR_LEFT)
        return hidden
