# SPDX-License-Identifier: MIT
"""Find every exposure of a robot with a marker in one merged picture.

In a mean, or a picture of darkest values, exposures are superposed: the whole template is
compared, and the threshold is lower beside a clearer exposure with nearly the same heading. Pasted
exposures occlude each other: those fully visible are found first, and the others by the
appearance of the whole body in the clearest of them, as without a marker (`by_look`). No exposure
is accepted for its position alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from tracking.body import Alignment, BodyTemplate, TopPlate, align, floor_in_view
from tracking.body.plane import Plane
from tracking.camera.lens import Camera, CameraPose
from tracking.composite.exposure import Exposure, disturbance, widened
from tracking.composite.known import KnownExposure
from tracking.composite.match import CELLS, match_whole
from tracking.composite.pasted import PastedReading
from tracking.composite.reading import Merged
from tracking.composite.steps import LEAST_STEP, apart, is_apart, is_beside, usual_step
from tracking.errors import CompositeError
from tracking.pose import BodyPrior

LONELY_SCORE = 0.65
"""Least correlation of an exposure without a clearer one beside it [-]."""

BESIDE_SCORE = 0.5
"""Least correlation of an exposure beside a clearer one with nearly the same heading [-]."""

CLEAR_SCORE = 0.85
"""Least correlation of a fully visible exposure in a pasted picture [-]."""

CLEAR_SPREAD = 0.03
"""Largest amount by which a fully visible exposure's correlation is below the greatest [-]."""

SHOWS_WHOLE = 0.9
"""Visible share of a body from which its marker, if there is one, must have been found [-]."""

OTHERS_SD = 1 / 200
"""Standard deviation of position where other things are as strong as the robot, in lengths of its
template [-].

Superposed exposures are not white noise that averages out over many points: they have edges and
cells of their own, which bias the alignment. The standard deviation is proportional to their
power, (1 - score²) / score². The value was calibrated on 336 exposures of simulated walks that no
test uses."""

_LEVER = 0.7  # lever arm for the heading, of the template's length
_SAME = 0.4  # of the template's length: nearer ones are the same
_DIVERGED = 0.1  # of the template's length: alignment by edges that moves farther has diverged
_HOPE = 0.8  # of the least correlation: with less after a few steps alignment stops


def find_exposures(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, template: BodyTemplate,
    prior: BodyPrior, merged: Merged, body_size: tuple[float, float] | None = None,
    hidden: NDArray[np.bool_] | None = None, near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find all exposures of a robot with a marker in one composite picture.

    Args:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        template: Template of the robot's marker (`tracking.body.marker_template`).
        prior: Prior of the body's height and tilt.
        merged: How the exposures were merged.
        body_size: Length and width of the robot's body, by which pasted exposures hide each other
            and are compared; None for the template's plate [m].
        hidden: True at pixels to ignore, as on the floor's markers, shape (height, width).
        near: x and y of the middle of the square to search [m]; None for the whole picture.
        reach: Half the side of that square [m].

    Returns:
        The exposures, not in order of the walk: those found by the marker first, in first place
        the one of greatest correlation.

    Raises:
        CompositeError: When none is found.
        ValueError: When the picture shows nothing of the marker's plane (see `floor_in_view`).
    """
    size = body_size or (template.plate.length, template.plate.width)
    area = floor_in_view(camera, view, prior.height + template.plate.height, near, reach)
    hidden = np.zeros(pixels.shape[:2], dtype=bool) if hidden is None else hidden
    search = _Search(_without(pixels, hidden), hidden, camera, view, template, prior, size, area)
    found = search.superposed()
    if merged is Merged.PASTED:
        found = search.layers(found)
    elif merged is Merged.DARKEST:
        found = search.apart_as_pasted(found)
    if not found:
        raise CompositeError(
            "no exposure of the robot is found in the composite picture; check the marker's number "
            f"and dictionary and that --merged {merged} is how the picture was made, or annotate "
            "the robot's top in one exposure and track --without-marker"
        )
    return tuple(found)


def _without(pixels: NDArray[np.uint8], hidden: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return the picture with hidden pixels filled with the median colour of the others.

    Without hidden pixels it is the same array.
    """
    if not hidden.any():
        return pixels
    painted = pixels.copy()
    painted[hidden] = np.median(pixels[~hidden][::7], axis=0).astype(np.uint8)
    return painted


@dataclass(frozen=True)
class _Search:
    pixels: NDArray[np.uint8]
    hidden: NDArray[np.bool_]
    camera: Camera
    view: CameraPose
    template: BodyTemplate
    prior: BodyPrior
    body: tuple[float, float]
    area: tuple[Array, Array]

    def superposed(self) -> list[Exposure]:
        """Find exposures by correlation with the whole marker; `visible` is 1 for all.

        They have at least `BESIDE_SCORE`, are selected by `along_a_walk` and `refined`.
        """
        top = self.template.plate
        half = 0.5 * float(np.hypot(top.length, top.width))
        plane = Plane.over(
            self.camera, self.view, height=self.prior.height + top.height,
            low=self.area[0] - half, high=self.area[1] + half, cell=top.length / CELLS,
        )  # fmt: skip
        picture = plane.read_smooth(self.pixels).mean(axis=2, keepdims=True)
        matches = match_whole(picture, plane, template=self.template, least=0.9 * BESIDE_SCORE)
        scores = [match.score for match in matches]
        starts = apart([match.planar for match in matches], scores, _SAME * top.length)
        aligned = [self.aligned(start, least_hope=_HOPE * BESIDE_SCORE) for start in starts]
        good = [each for each in aligned if each is not None and each.score >= BESIDE_SCORE]
        good.sort(key=lambda alignment: -alignment.score)
        return [Exposure(self.refined(each), 1.0) for each in self.along_a_walk(good)]

    def aligned(
        self, start: Array, *, least_hope: float, shines_through: bool = False
    ) -> Alignment | None:
        """Align the marker with the picture from `start`, x, y, yaw (3,); None as for `align`."""
        return align(
            self.pixels, self.camera, self.view, template=self.template, prior=self.prior,
            start=start, blurs_px=(1.0,), least_hope=least_hope, shines_through=shines_through,
        )  # fmt: skip

    def along_a_walk(self, good: Sequence[Alignment]) -> list[Alignment]:
        """Keep exposures of `LONELY_SCORE`, those beside kept ones, and so on (hysteresis).

        Those nearer than 0.4 lengths of the marker to a kept one are dropped.
        """
        kept: list[Alignment] = []
        left = list(good)
        while index := [k for k, each in enumerate(left) if self.follows(each, kept)][:1]:
            new, poses = left.pop(index[0]), [each.pose.planar for each in kept]
            if is_apart(new.pose.planar, poses, _SAME * self.template.plate.length):
                kept.append(new)
        return kept

    def follows(self, alignment: Alignment, kept: Sequence[Alignment]) -> bool:
        """Return whether an exposure has `LONELY_SCORE` or is beside a kept one (`is_beside`)."""
        here, poses = alignment.pose.planar, [each.pose.planar for each in kept]
        return alignment.score >= LONELY_SCORE or is_beside(here, poses, self.body[0])

    def refined(self, alignment: Alignment) -> Alignment:
        """Refine an alignment by edges alone, as other exposures or the floor shine through.

        Where that diverges the alignment stays. The score is kept; the error that superposed
        exposures cause is added to the covariance.
        """
        length, start = self.template.plate.length, alignment.pose.planar
        fine = self.aligned(start, least_hope=0.0, shines_through=True)
        if fine is None or is_apart(fine.pose.planar, [start], _DIVERGED * length):
            fine = alignment
        slip = OTHERS_SD * length * disturbance(fine)
        return replace(widened(fine, slip, lever=_LEVER * length), score=alignment.score)

    def layers(self, whole: Sequence[Exposure]) -> list[Exposure]:
        """Find exposures that occlude each other, from `whole`, those found by the marker.

        Kept are those of high correlation (`CLEAR_SCORE`, `CLEAR_SPREAD`), and exposures found by
        the body's appearance elsewhere: less than 0.9 visible as found, others only with one of
        `whole` there, as that. Where none is kept, as in a blurred picture, `whole` is returned.
        """
        best = max((each.alignment.score for each in whole), default=0.0)
        least = max(CLEAR_SCORE, best - CLEAR_SPREAD)
        clear = [each for each in whole if each.alignment.score >= least]
        same = LEAST_STEP * self.body[0]
        found = list(clear)
        for new in self.occluded_by(clear):
            if is_apart(new.planar, [each.planar for each in clear], same):
                options = [new] if new.visible < SHOWS_WHOLE else whole
                found += [x for x in options if not is_apart(new.planar, [x.planar], same)][:1]
        return found or list(whole)

    def apart_as_pasted(self, whole: Sequence[Exposure]) -> list[Exposure]:
        """Align exposures of a picture of darkest values as pasted ones where they are apart.

        They then hide nothing of each other. Where they overlap, or `layers` finds others than
        `whole`, those found by the marker, `whole` is returned.
        """
        poses = np.array([each.planar for each in whole])
        if len(whole) < 2 or usual_step(poses) < self.body[0]:
            return list(whole)
        found, same = self.layers(whole), LEAST_STEP * self.body[0]
        missed = any(is_apart(pose, [each.planar for each in found], same) for pose in poses)
        return found if len(found) == len(whole) and not missed else list(whole)

    def occluded_by(self, clear: Sequence[Exposure]) -> Sequence[Exposure]:
        """Find exposures, also occluded ones, by the body's appearance in a fully visible one.

        The first usable of `clear` is taken, and comes first; empty if none is.
        """
        top = TopPlate(*self.body, self.template.plate.height, 0.0, 0.0, 0.0)
        for exposure in clear:
            picture = KnownExposure(
                self.pixels, self.camera, self.view, self.prior, exposure.alignment.pose, top,
                self.body, self.hidden, self.area,
            )  # fmt: skip
            try:
                picture.body_template(self.pixels)
            except CompositeError:
                continue  # cut by the picture's edge, too small or too faint: try the next
            reading = PastedReading.of(picture)
            return reading.align(reading.find())
        return []
