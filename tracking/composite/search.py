# SPDX-License-Identifier: MIT
"""Find every exposure of a robot with a marker in one merged picture.

A picture may have been merged in two ways, and nothing in it says in which:

* exposures shine through each other (mean or darkest value of each pixel): each is there as a
  whole, among what is seen of the others;
* exposures lie on each other (cut out and pasted): each is there as far as no other hides it.

It is read in both ways, and the reading that finds more is taken. Of exposures that shine through,
all of the robot's picture is compared, with a threshold that is lower beside a clearer exposure
with nearly the same heading than alone. Of exposures that hide each other those that show whole are
found first; where they are the picture is taken from it, and beside them the whole body, as one of
them shows it, is compared by its visible part. How they were cut out is not known either: closely,
or with the floor and the shadow around them, which hide more and show the body's outline. Nothing
is accepted by its place alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracking.body import (
    Alignment,
    BodyTemplate,
    TopPlate,
    align,
    floor_in_view,
    make_template,
)
from tracking.camera.lens import Array, Camera, CameraPose
from tracking.composite.body_box import BodyBox
from tracking.composite.exposure import Exposure
from tracking.composite.match import CELLS, Match, match_visible, match_whole
from tracking.composite.plane import Plane
from tracking.errors import BodyError, CompositeError
from tracking.pose import BodyPrior

LONELY_SCORE = 0.65
"""Least correlation of an exposure with no clearer one beside it [-]."""

BESIDE_SCORE = 0.5
"""Least correlation of one beside a clearer one with nearly its heading [-]."""

CLEAR_SCORE = 0.85
"""Least correlation of one that hides others [-]."""

CLEAR_SPREAD = 0.03
"""How much less clear than the clearest an exposure may be that shows whole [-]."""

LEAST_SHARE = 0.15
"""Least share of the body that must be visible [-]."""

LEAST_SAMENESS = 0.6
"""Least concordance of the visible part of a hidden exposure with the clear one it is compared to.
Being of one picture they have light and contrast in common, which a floor's pattern has not [-]."""

OTHERS_SD = 1 / 200
"""Error of a place where others show as much as the robot does, in lengths of its template.

What shines through is no noise that many points average away: it has edges and cells of its own,
which draw the alignment to them. It grows with their power, (1 - score²) / score², and was chosen
by 336 exposures of simulated walks that no test draws."""

_LEVER = 0.7  # of the template's length: that much off at its ends turns it
_SAME = 0.4  # of the template's length: nearer than this two are one
_SLIP = 0.1  # of the template's length: farther edges alone lead astray
_BESIDE = 1.25  # of the body's length
_TURN = np.radians(32.0)  # from one exposure to the next beside it
_SAME_BODY = 0.25  # of the body's length: nearer than this one hides all of the other
_BODY_CELLS = 40
_MOST_TRIED = 4
_HOPE = 0.8  # of the least correlation: less after a few steps is given up


@dataclass(frozen=True)
class Scissors:
    """How exposures were cut out before they were pasted on each other.

    Attributes:
        left: What is left around the robot and hides others, as a share of its length [-].
        outline: How much around the robot is compared, as a share of its length [-].
        least_score: Least correlation of what is visible of a hidden exposure [-].
    """

    left: float
    outline: float
    least_score: float


CLOSE = Scissors(left=0.05, outline=0.0, least_score=CLEAR_SCORE)
"""Along the robot's edge."""

WIDE = Scissors(left=0.15, outline=0.08, least_score=0.7)
"""With floor and shadow. Of simulated composites, places of no exposure come to less than 0.6 and
exposures to 0.75 and more."""


def find_exposures(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, template: BodyTemplate,
    prior: BodyPrior, body_size: tuple[float, float] | None = None,
    hidden: NDArray[np.bool_] | None = None, near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find all exposures of the robot in one picture.

    Args:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: The lens.
        view: Where the camera stood.
        template: The picture of the robot's marker (`tracking.body.marker_template`).
        prior: Height and tilt.
        body_size: Length and width of the robot's body, which hides others where it was cut out and
            pasted; the template's plate when None [m].
        hidden: Pixels that do not show the robot, as those of the floor's markers, shape
            (height, width).
        near: x and y near which to look [m]; the whole picture when None.
        reach: How far from there [m].

    Returns:
        The exposures, the clearest first.

    Raises:
        CompositeError: When none is found.
    """
    size = body_size or (template.plate.length, template.plate.width)
    area = floor_in_view(camera, view, prior.height + template.plate.height, near, reach)
    search = _Search(_without(pixels, hidden), camera, view, template, prior, size, area)
    through = search.shining_through()
    layers = search.layers(through)
    found = layers if len(layers) >= len(through) else through
    if not found:
        raise CompositeError(
            "no exposure of the robot is found in the composite picture; check the marker's number "
            "and dictionary, or mark the top of one exposure and go without"
        )
    return tuple(found)


def _without(pixels: NDArray[np.uint8], hidden: NDArray[np.bool_] | None) -> NDArray[np.uint8]:
    """Paint over what does not show the robot, in the picture's usual colour."""
    if hidden is None or not hidden.any():
        return pixels
    painted = pixels.copy()
    painted[hidden] = np.median(pixels[~hidden][::7], axis=0).astype(np.uint8)
    return painted


@dataclass(frozen=True)
class _Search:
    pixels: NDArray[np.uint8]
    camera: Camera
    view: CameraPose
    template: BodyTemplate
    prior: BodyPrior
    body: tuple[float, float]
    area: tuple[Array, Array]

    def shining_through(self) -> list[Exposure]:
        """Find exposures that show as a whole, each among what is seen of others."""
        plane = self.plane(self.template, self.template.plate.length / CELLS)
        picture = plane.read_smooth(self.pixels).mean(axis=2, keepdims=True)
        matches = match_whole(picture, plane, template=self.template, least=0.9 * BESIDE_SCORE)
        aligned = [self.aligned(match) for match in self.apart(matches)]
        good = [each for each in aligned if each is not None and each.score >= BESIDE_SCORE]
        good.sort(key=lambda alignment: -alignment.score)
        return [Exposure(self.sharpened(each), 1.0) for each in self.along_a_walk(good)]

    def sharpened(self, alignment: Alignment) -> Alignment:
        """Align by edges alone what others, or the floor, are seen through; its score stays."""
        fine = align(
            self.pixels, self.camera, self.view, template=self.template, prior=self.prior,
            start=alignment.pose.planar, blurs_px=(1.0,), least_hope=0.0, shines_through=True,
        )  # fmt: skip
        if fine is None or self.distance(fine.pose.planar, alignment.pose.planar) > self.slip:
            return self.among_others(alignment)
        return replace(self.among_others(fine), score=alignment.score, sameness=alignment.sameness)

    @property
    def slip(self) -> float:
        return _SLIP * self.template.plate.length

    def among_others(self, alignment: Alignment) -> Alignment:
        """Add what others that shine through do to the place and heading of an exposure."""
        power = max(1 - alignment.score**2, 0.0) / alignment.score**2
        slip = OTHERS_SD * self.template.plate.length * power
        turn = slip / (_LEVER * self.template.plate.length)
        added = np.diag([slip, slip, 0, 0, 0, turn]) ** 2
        pose = replace(alignment.pose, covariance=alignment.pose.covariance + added)
        return replace(alignment, pose=pose)

    def plane(self, template: BodyTemplate, cell: float) -> Plane:
        half = 0.5 * float(np.hypot(template.plate.length, template.plate.width))
        height = self.prior.height + template.plate.height
        low, high = self.area[0] - half, self.area[1] + half
        return Plane.over(self.camera, self.view, height=height, low=low, high=high, cell=cell)

    def aligned(self, match: Match) -> Alignment | None:
        return align(
            self.pixels, self.camera, self.view, template=self.template, prior=self.prior,
            start=match.planar, blurs_px=(1.0,), least_hope=_HOPE * BESIDE_SCORE,
        )  # fmt: skip

    def apart(self, matches: Sequence[Match]) -> list[Match]:
        """Keep the best of matches in one place."""
        kept: list[Match] = []
        for match in matches:
            if all(self.distance(match.planar, other.planar) > self.same for other in kept):
                kept.append(match)
        return kept

    @property
    def same(self) -> float:
        return _SAME * self.template.plate.length

    @staticmethod
    def distance(a: Array, b: Array) -> float:
        return float(np.hypot(*(a[:2] - b[:2])))

    def along_a_walk(self, good: Sequence[Alignment]) -> list[Alignment]:
        """Keep what is clear by itself, and what is beside that, and so on."""
        kept: list[Alignment] = []
        left = list(good)
        while left:
            index = next((k for k, each in enumerate(left) if self.follows(each, kept)), None)
            if index is None:
                break
            new = left.pop(index)
            here = new.pose.planar
            if all(self.distance(here, other.pose.planar) > self.same for other in kept):
                kept.append(new)
        return kept

    def follows(self, alignment: Alignment, kept: Sequence[Alignment]) -> bool:
        here = alignment.pose.planar
        return alignment.score >= LONELY_SCORE or any(
            self.distance(here, other.pose.planar) < _BESIDE * self.body[0]
            and np.cos(here[2] - other.pose.planar[2]) > np.cos(_TURN)
            for other in kept
        )

    def layers(self, whole: Sequence[Exposure]) -> list[Exposure]:
        """Find exposures that hide each other, beginning with those that show whole."""
        best = max((each.alignment.score for each in whole), default=0.0)
        least = max(CLEAR_SCORE, best - CLEAR_SPREAD)
        clear = [each for each in whole if each.alignment.score >= least]
        return max((self.stacked(clear, scissors) for scissors in (CLOSE, WIDE)), key=len)

    def stacked(self, clear: Sequence[Exposure], scissors: Scissors) -> list[Exposure]:
        """Find what exposures that show whole hide."""
        body = self.body_template(clear, scissors)
        if body is None:
            return list(clear)
        plane = self.plane(body, body.plate.length / _BODY_CELLS)
        stack = _Stack(self, scissors, body, plane, plane.read_smooth(self.pixels))
        return stack.grown(clear)

    def body_template(self, clear: Sequence[Exposure], scissors: Scissors) -> BodyTemplate | None:
        """Cut the whole body out of an exposure that shows whole."""
        around = scissors.outline * self.body[0]
        plate = TopPlate(*self.body, self.template.plate.height, 0.0, around, around)
        for exposure in sorted(clear, key=lambda each: -each.alignment.score):
            try:
                return make_template(
                    self.pixels, self.camera, self.view, pose=exposure.alignment.pose, plate=plate
                )
            except BodyError:
                continue  # cut by the picture's edge: the next may not be
        return None


@dataclass(frozen=True)
class _Stack:
    """Exposures that hide each other."""

    search: _Search
    scissors: Scissors
    body: BodyTemplate
    plane: Plane
    picture: NDArray[np.float32]

    def grown(self, clear: Sequence[Exposure]) -> list[Exposure]:
        """Look beside every exposure for one that it hides, until none is found."""
        found = list(clear)
        visible = np.ones(self.search.pixels.shape[:2], dtype=bool)
        for each in clear:
            visible &= ~self.covered(each.alignment)
        for count, seed in enumerate(found):  # grows while it is gone through
            while (new := self.beside(seed, found, visible)) is not None:
                found.append(new)
                visible &= ~self.covered(new.alignment)
                if count >= len(clear):
                    break  # it hides one at most; the others may lie on both sides
        return found

    def beside(
        self, seed: Exposure, found: Sequence[Exposure], visible: NDArray[np.bool_]
    ) -> Exposure | None:
        """Find the exposure that fits best beside another."""
        here = seed.alignment.pose.planar
        reach = _BESIDE * self.search.body[0]
        half = 0.5 * float(np.hypot(*self.search.body))
        plane = self.plane.window(here[None, :2], reach + half + 2 * self.plane.cell)
        seen = (plane.read(255 * visible.astype(np.uint8)) > 230).astype(np.float32)
        matches = match_visible(
            self.cut(plane), seen, plane, template=self.body, least=0.6, share=LEAST_SHARE,
            yaws=[here[2]], within=_TURN,
        )  # fmt: skip
        near = [match for match in matches if self.search.distance(match.planar, here) < reach]
        new = [self.aligned(match, visible) for match in near[:_MOST_TRIED]]
        fits = [each for each in new if each is not None and self.is_new(each, found)]
        return max(fits, key=lambda each: each.alignment.score, default=None)

    def cut(self, window: Plane) -> NDArray[np.float32]:
        column = round(float(window.low[0] - self.plane.low[0]) / self.plane.cell)
        row = round(float(self.plane.high[1] - window.high[1]) / self.plane.cell)
        rows, columns = window.seen_px.shape[:2]
        return self.picture[row : row + rows, column : column + columns]

    def aligned(self, match: Match, visible: NDArray[np.bool_]) -> Exposure | None:
        alignment = align(
            self.search.pixels, self.search.camera, self.search.view, template=self.body,
            prior=self.search.prior, start=match.planar, visible=visible,
            least_visible=0.8 * LEAST_SHARE, least_hope=_HOPE * self.scissors.least_score,
        )  # fmt: skip
        if alignment is None or alignment.score < self.scissors.least_score:
            return None
        share = self.share(alignment, visible)
        if alignment.sameness < LEAST_SAMENESS or share < LEAST_SHARE:
            return None
        return Exposure(alignment, share)

    def is_new(self, exposure: Exposure, found: Sequence[Exposure]) -> bool:
        here = exposure.alignment.pose.planar
        same = _SAME_BODY * self.search.body[0]
        return all(self.search.distance(here, each.alignment.pose.planar) > same for each in found)

    def covered(self, alignment: Alignment) -> NDArray[np.bool_]:
        """Mark the pixels that an exposure hides, and what scissors leave around it."""
        return self.box.hidden(alignment.pose.state, left=self.scissors.left)

    def share(self, alignment: Alignment, visible: NDArray[np.bool_]) -> float:
        """Compute the share of an exposure's top that is visible."""
        own = self.box.top_seen(alignment.pose.state)
        return float((own & visible).sum() / max(int(own.sum()), 1))

    @property
    def box(self) -> BodyBox:
        """The robot's body."""
        search = self.search
        top = search.template.plate.height
        return BodyBox(search.camera, search.view, search.body, top, search.prior.height)
