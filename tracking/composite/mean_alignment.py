# SPDX-License-Identifier: MIT
"""Align the exposures of a mean, each as faint as 1/n, with each other.

A template cut out of one exposure of a mean contains the floor of that place, as strong as in the
picture. Each exposure is therefore aligned with the mean of the others, in which that floor is
weaker, in colours that are rare on the floor. Then all are moved together so that the known one is
at its known pose.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body import Alignment, BodyTemplate
from tracking.body.template import MOST_POINTS, sample
from tracking.camera.lens import project
from tracking.composite.colours import SCALE, FloorColours
from tracking.composite.exposure import Exposure
from tracking.composite.floor_pattern import FloorPattern
from tracking.composite.known import LEVER, KnownExposure
from tracking.composite.pattern_alignment import AROUND, PatternAlignment
from tracking.composite.steps import step_between, stepped
from tracking.pose import PLANAR, BodyPose, body_to_floor

LEAST_CLEAR_SCORE, LEAST_FAINT_SCORE = 0.4, 0.2
"""Least correlation of edges to use an alignment of overlapping exposures, and, lower, for the
alignment not to count as failed [-]."""

LEAST_NEW_SCORE = 0.1
"""Least correlation of prewhitened pixels to use an alignment of exposures that are apart [-]."""

MEAN_SD, MEAN_OVERLAP_SD = 1 / 1200, 1 / 220
"""Standard deviation of position of exposures that are apart and of exposures that overlap, where
other things are as strong as the robot, in lengths of the robot [-]."""

_ROUNDS = 2
_FLOOR_LEFT = 0.15  # of the length: beyond it from all exposures is floor
_EVERY_PIXEL = 250_000  # points: of a robot of 500 x 500 px
_FINE_WIDTH = 1 / 24  # of the length: wider variation is not fine pattern
_PATTERN_WIDTH = 0.25  # of the length: wider variation is not pattern
_HALF_LEVER = 0.5  # lever arm for the heading, of the length


def floor_pattern(
    picture: KnownExposure, weighed: NDArray[np.float32], poses: Array
) -> FloorPattern:
    """Fit the pattern of the floor to the pixels farther than 0.15 lengths from all exposures.

    Args:
        picture: The picture and the known exposure.
        weighed: The picture in whitened colours, shape (height, width, 3).
        poses: x, y and yaw of all exposures, shape (n, 3) [m, m, rad].

    Raises:
        CompositeError: There is no such floor.
    """
    floor = ~picture.hidden
    for pose in poses:
        floor &= ~picture.box.hidden(picture.level(pose), left=_FLOOR_LEFT)
    return FloorPattern.of(weighed, floor, width=_PATTERN_WIDTH * picture.length_px)


def fine_whitening(picture: KnownExposure) -> Array:
    """Compute the matrix W (3, 3) that whitens the floor's fine pattern to deviation `SCALE`.

    It applies to colours as rows, (n, 3) @ W; fine is below 1/24 of the robot's length.
    Lenses and JPEG reduce fine detail of colour more than of brightness.
    """
    pixels, width = picture.pixels.astype(np.float32), _FINE_WIDTH * picture.length_px
    floor = FloorColours.of(pixels, ~picture.hidden, width=width, noise=0.5)
    return (SCALE * floor.whitening).astype(np.float32)


@dataclass(frozen=True)
class MeanAlignment:
    """Alignment of the exposures of a mean with each other.

    Attributes:
        known: The picture and the known exposure.
        residuals: For each exposure the picture after all others are subtracted, whitened, shape
            (height, width, 3); high-pass filtered (`FloorPattern.flat`) if `pattern` is given.
        poses: x, y and yaw found on the raster, the known one first, shape (n, 3) [m, m, rad].
        pattern: Prediction filter of the floor, for exposures that are apart: prediction errors of
            the tops are aligned. None for exposures that overlap: edges of bodies are aligned.
    """

    known: KnownExposure
    residuals: Sequence[NDArray[np.float32]]
    poses: Array
    pattern: FloorPattern | None = None

    @property
    def least_clear(self) -> float:
        """Least correlation to use an alignment: `LEAST_NEW_SCORE` if there is a `pattern`.

        `LEAST_CLEAR_SCORE` without.
        """
        return LEAST_CLEAR_SCORE if self.pattern is None else LEAST_NEW_SCORE

    def exposures(self) -> tuple[Exposure, ...]:
        """Align all exposures, the known one first.

        Exposures of a correlation below `least_clear` keep the raster's pose. Where exposures
        overlap they are dropped, but not the known one, and none if that could not be aligned.
        """
        overlap, found, exposures = self.pattern is None, self.with_others(), []
        slip, lever = (MEAN_OVERLAP_SD, _HALF_LEVER) if overlap else (MEAN_SD, LEVER)
        for k, (each, pose) in enumerate(zip(found, self.poses, strict=True)):
            if each is not None and each.score >= self.least_clear:
                exposures.append(Exposure(self.known.widened(each, slip, lever=lever), 1.0))
            elif not overlap or k == 0 or found[0] is None:
                exposures.append(Exposure(self.known.rough(pose), 1.0))
        return tuple(exposures)

    def with_others(self) -> list[Alignment | None]:
        """Align each exposure with the mean of the others, twice; None where it diverges.

        None for all where the known one diverges or has too small a correlation (`anchored`). Of n
        poses each moves by (n - 1) / n of its step.
        """
        poses, found = self.poses, []
        share = (len(poses) - 1) / len(poses)
        for _ in range(_ROUNDS):
            triples = zip(poses, self.residuals, self.others_templates(poses), strict=True)
            found = self.anchored([self.aligned(*each) for each in triples])
            # The others have errors too: this share of the step is the best estimate.
            poses = np.array([
                pose if each is None
                else stepped(pose, share * step_between(pose, each.pose.planar))
                for each, pose in zip(found, poses, strict=True)
            ])  # fmt: skip
        return [
            each and replace(each, pose=_moved(each.pose, pose))
            for each, pose in zip(found, poses, strict=True)
        ]

    def aligned(
        self, pose: Array, residual: NDArray[np.float32], template: BodyTemplate
    ) -> Alignment | None:
        """Align one exposure by prewhitened pixels if there is a pattern, else by edges.

        Args:
            pose: Pose to start from, shape (3,) [m, m, rad].
            residual: The picture after all others are subtracted, shape (height, width, 3).
            template: Template of the robot.

        Returns:
            The alignment, or None where it fails, correlates too little or moves too far.
        """
        if self.pattern is None:
            return self.known.aligned(
                pose, residual, template, ~self.known.hidden, least=LEAST_FAINT_SCORE,
                shines_through=True,
            )  # fmt: skip
        found = PatternAlignment(self.known, residual, template, self.pattern, pose).solved()
        diverged = found is None or self.known.has_diverged(found, pose, LEAST_NEW_SCORE)
        return None if diverged else found

    def others_templates(self, poses: Array) -> list[BodyTemplate]:
        """Build a template for each exposure: the mean picture of all others (leave-one-out).

        A mean over all would contain the exposure itself and bias its alignment to where it starts.

        Args:
            poses: x, y and yaw of all exposures, shape (n, 3) [m, m, rad].

        Raises:
            CompositeError: The known exposure is too small or, in its residual, too faint.
        """
        picture, plate, most = self.known, self.known.body_plate, MOST_POINTS
        if self.pattern is not None:
            # What is around the top lies lower, and its parallax differs.
            around, most = AROUND * picture.plate.length, _EVERY_PIXEL
            plate = replace(picture.plate, margin=around, front_margin=around)
        first = picture.template(self.residuals[0], plate, most_points=most)
        shape, points = first.points_body.shape[:2], first.points_body.reshape(-1, 3)
        shown = (~picture.hidden).astype(np.float32)
        looks, weights = [], []
        for residual, pose in zip(self.residuals, poses, strict=True):
            state = picture.level(pose)
            seen = project(picture.camera, picture.view, body_to_floor(points, state))
            seen = seen.reshape(*shape, 2)
            weight = (sample(shown, seen) > 0.99)[..., None].astype(float)  # 0 outside, too
            look = sample(residual, seen) * weight
            usual = look.sum(axis=(0, 1)) / max(float(weight.sum()), 1.0)
            looks.append(look - usual * weight)
            weights.append(weight)
        total, count = np.sum(looks, axis=0), np.sum(weights, axis=0)
        means = [
            (total - look) / np.maximum(count - weight, 1)
            for look, weight in zip(looks, weights, strict=True)
        ]
        return [replace(first, colours=mean.astype(np.float32)) for mean in means]

    def anchored(self, found: Sequence[Alignment | None]) -> list[Alignment | None]:
        """Move all exposures, in their own frames, by the step of the first to its known pose.

        The first one's covariance is added to the others'; if its correlation is too small, all
        become None. The error of the known pose is not added.
        """
        first = found[0]
        if first is None or first.score < self.least_clear:
            return [None] * len(found)
        off = step_between(self.known.pose.planar, first.pose.planar)
        common = np.zeros((6, 6))
        common[np.ix_(PLANAR, PLANAR)] = first.pose.covariance[np.ix_(PLANAR, PLANAR)]
        moved: list[Alignment | None] = []
        for k, each in enumerate(found):
            if each is None:
                moved.append(None)
                continue
            pose = _moved(each.pose, stepped(each.pose.planar, -off))
            covariance = pose.covariance + (common if k else 0.0)
            moved.append(replace(each, pose=replace(pose, covariance=covariance)))
        return moved


def _moved(pose: BodyPose, planar: Array) -> BodyPose:
    state = pose.state.copy()
    state[PLANAR] = planar
    return replace(pose, state=state)
