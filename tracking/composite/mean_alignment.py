# SPDX-License-Identifier: MIT
"""Align the exposures of a mean, each as faint as 1/n, with each other.

A template cut out of one exposure of a mean contains the floor of that place, as strong as in the
picture. Each exposure is therefore aligned with the mean of the others, in which that floor is
weaker, in colours that are rare on the floor. Then all are moved together so that the known one is
at its known pose.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracking.body import Alignment, BodyTemplate, TopPlate
from tracking.body.template import MOST_POINTS, sample
from tracking.camera.lens import Array, project
from tracking.composite.chain import step_between, stepped, stepped_back, usual_step
from tracking.composite.colours import FloorColours
from tracking.composite.exposure import Exposure
from tracking.composite.floor_pattern import FloorPattern
from tracking.composite.known import LEVER, KnownExposure
from tracking.composite.mean import SCALE, MeanSearch
from tracking.composite.pattern_alignment import AROUND, PatternAlignment
from tracking.pose import PLANAR, BodyPose, rotation_with_derivatives

LEAST_CLEAR_SCORE, LEAST_FAINT_SCORE = 0.4, 0.2
"""Least correlation of an exposure's edges to use an alignment, and not to reject it [-]."""

LEAST_NEW_SCORE = 0.1
"""Least correlation of an exposure's part that the floor's pattern does not predict [-]."""

MEAN_SD, MEAN_OVERLAP_SD = 1 / 1200, 1 / 220
"""Error of position, as `tracking.composite.pasted_alignment.PASTED_SD`, of exposures that are
apart and of those that overlap [-]."""

_CELLS = 32  # points of the raster along the robot
_AROUND = 0.28  # of the length: how far sides, legs and shadow reach
_ROUNDS = 2
_FLOOR_LEFT = 0.15  # of the length: beyond it from all exposures is floor
_EVERY_PIXEL = 250_000  # points: of a robot of 500 x 500 px
_FINE_WIDTH = 1 / 24  # of the length: wider variation is not fine pattern
_PATTERN_WIDTH = 0.25  # of the length: wider variation is not pattern
_HALF_LEVER = 0.5  # lever arm for the heading, of the length


@dataclass(frozen=True)
class MeanReading:
    """Reading of a picture that is the mean of several exposures.

    Attributes:
        picture: The picture and the known exposure.
    """

    picture: KnownExposure

    @cached_property
    def search(self) -> MeanSearch:
        """The picture on a raster that reaches over what sides and legs cover."""
        length = self.picture.size[0]
        raster = self.picture.raster(length / _CELLS, round(_AROUND * _CELLS))
        return MeanSearch(*raster, length, self.picture.plate.height)

    def find(self) -> Array:
        """Find all exposures, the known one first, shape (n, 3)."""
        return self.search.find(self.picture.known.planar)

    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align each exposure with the residual that the others leave of the picture.

        Args:
            poses: Places on the raster, the known one first, shape (n, 3).

        Returns:
            The exposures, the known one first; where they overlap, without those that are unclear.
        """
        picture, search = self.picture, self.search
        fine = fine_weighing(picture)
        weighed = (picture.pixels @ fine).astype(np.float32)
        alones = self.alone(poses, weighed, np.linalg.inv(search.weighing) @ fine)
        if usual_step(poses) < picture.size[0]:
            return MeanAlignment(picture, alones, poses).exposures()
        pattern = floor_pattern(picture, weighed, poses)
        flat = [pattern.flat(alone) for alone in alones]
        return MeanAlignment(picture, flat, poses, pattern).exposures()

    def alone(
        self, poses: Array, weighed: NDArray[np.float32], weighed_again: Array
    ) -> list[NDArray[np.float32]]:
        """Subtract the other exposures from the picture, around each exposure.

        Args:
            poses: The exposures, shape (n, 3).
            weighed: The picture in weighed colours, shape (height, width, 3).
            weighed_again: From the raster's weighed colours to those, shape (3, 3).
        """
        robot = self.search.robot_at(poses, self.search.change)
        alones = []
        for k, pose in enumerate(poses):
            others = self.search.sum_of(np.delete(poses, k, axis=0), robot)
            seen = self.picture.on_photo(others, self.search.plane, pose)
            alones.append((weighed - seen @ weighed_again).astype(np.float32))
        return alones


def floor_pattern(
    picture: KnownExposure, weighed: NDArray[np.float32], poses: Array
) -> FloorPattern:
    """Fit the pattern of the floor to the pixels far from all exposures.

    Args:
        picture: The picture and the known exposure.
        weighed: The picture in whitened colours, shape (height, width, 3).
        poses: The exposures, shape (n, 3) [m, m, rad].
    """
    floor = ~picture.hidden
    for pose in poses:
        floor &= ~picture.box.hidden(picture.level(pose), left=_FLOOR_LEFT)
    return FloorPattern.of(weighed, floor, width=_PATTERN_WIDTH * picture.length_px)


def fine_weighing(picture: KnownExposure) -> Array:
    """Compute the whitening matrix of the floor's fine pattern, shape (3, 3).

    Lenses and JPEG reduce fine detail of colour more than of brightness.
    """
    pixels, width = picture.pixels.astype(np.float32), _FINE_WIDTH * picture.length_px
    floor = FloorColours.of(pixels, ~picture.hidden, width=width, noise=0.5)
    return (SCALE * floor.whitening).astype(np.float32)


@dataclass(frozen=True)
class MeanAlignment:
    """Alignment of the exposures of a mean with each other.

    Attributes:
        picture: The picture and the known exposure.
        alones: What the others leave of the picture around each, shape (height, width, 3).
        poses: Where they are on a raster, the known one first, shape (n, 3).
        pattern: Of the floor, where exposures are apart: the prediction error of their tops is
            aligned, and `alones` are flat. None where they overlap: edges of bodies are aligned.
    """

    picture: KnownExposure
    alones: Sequence[NDArray[np.float32]]
    poses: Array
    pattern: FloorPattern | None = None

    def exposures(self) -> tuple[Exposure, ...]:
        """Align all exposures, the known one first."""
        return self.overlapping() if self.pattern is None else self.apart()

    def apart(self) -> tuple[Exposure, ...]:
        """Align exposures that do not overlap, by the top alone.

        What is around the top lies lower, and its parallax differs.
        """
        around = AROUND * self.picture.plate.length
        found = self.with_others(replace(self.picture.plate, margin=around, front_margin=around))
        return tuple(
            Exposure(self.clear_or_rough(each, pose, MEAN_SD, LEVER), 1.0)
            for each, pose in zip(found, self.poses, strict=True)
        )

    def overlapping(self) -> tuple[Exposure, ...]:
        """Align exposures that overlap, by the body; drop those whose edges correlate too little.

        The known one is kept. If its edges correlate too little, the others cannot be judged and
        keep their poses on the raster.
        """
        found = self.with_others(self.picture.body_plate)
        return tuple(
            Exposure(self.clear_or_rough(each, pose, MEAN_OVERLAP_SD, _HALF_LEVER), 1.0)
            for k, (each, pose) in enumerate(zip(found, self.poses, strict=True))
            if k == 0 or found[0] is None or _score(each) >= LEAST_CLEAR_SCORE
        )

    def with_others(self, plate: TopPlate) -> list[Alignment | None]:
        """Align a part of the robot with its mean in the others; None where one diverges."""
        poses = self.poses
        share = (len(poses) - 1) / len(poses)
        found: list[Alignment | None] = []
        for _ in range(_ROUNDS):
            templates = self.others_templates(poses, plate)
            found = self.anchored(self.aligned(poses, templates))
            # The others have errors too: this share of the step is the best estimate.
            poses = np.array([
                _nearer(pose, each, share) for each, pose in zip(found, poses, strict=True)
            ])  # fmt: skip
        return [
            each and replace(each, pose=_moved(each.pose, pose))
            for each, pose in zip(found, poses, strict=True)
        ]

    def aligned(self, poses: Array, templates: Sequence[BodyTemplate]) -> list[Alignment | None]:
        """Align each exposure with its template.

        Args:
            poses: Poses to start from, shape (n, 3) [m, m, rad].
            templates: One template for each.

        Returns:
            Alignments; None where one diverges.
        """
        pairs = zip(poses, self.alones, templates, strict=True)
        if self.pattern is None:
            return [self.edges_aligned(*each) for each in pairs]
        return [self.pattern_aligned(*each, self.pattern) for each in pairs]

    def edges_aligned(
        self, pose: Array, alone: NDArray[np.float32], template: BodyTemplate
    ) -> Alignment | None:
        """Align one exposure by its edges.

        Args:
            pose: Pose to start from, shape (3,) [m, m, rad].
            alone: What the others leave of the picture, shape (height, width, 3).
            template: Template of the robot.

        Returns:
            The alignment, or None where it diverges.
        """
        return self.picture.aligned(
            pose, alone, template, ~self.picture.hidden, least=LEAST_FAINT_SCORE,
            shines_through=True,
        )  # fmt: skip

    def pattern_aligned(
        self, pose: Array, alone: NDArray[np.float32], template: BodyTemplate, pattern: FloorPattern
    ) -> Alignment | None:
        """Align one exposure by what the floor's pattern does not predict.

        Args:
            pose: Pose to start from, shape (3,) [m, m, rad].
            alone: What the others leave of the picture, shape (height, width, 3).
            template: Template of the robot.
            pattern: Pattern of the floor.

        Returns:
            The alignment, or None where it diverges.
        """
        found = PatternAlignment(self.picture, alone, template, pattern, pose).solved()
        astray = found is None or self.picture.is_astray(found, pose, LEAST_NEW_SCORE)
        return None if astray else found

    @property
    def least_clear(self) -> float:
        """Least correlation of an exposure to use its alignment."""
        return LEAST_CLEAR_SCORE if self.pattern is None else LEAST_NEW_SCORE

    def others_templates(self, poses: Array, plate: TopPlate) -> list[BodyTemplate]:
        """Make a template for each exposure: the mean of all the others (leave-one-out).

        A mean over all would contain the exposure itself and bias its alignment to where it starts.

        Args:
            poses: The exposures, shape (n, 3) [m, m, rad].
            plate: Part of the robot's top to cut out.
        """
        picture = self.picture
        most = MOST_POINTS if self.pattern is None else _EVERY_PIXEL
        first = picture.template(self.alones[0], plate, most_points=most)
        shape, points = first.points_body.shape[:2], first.points_body.reshape(-1, 3)
        shown = (~picture.hidden).astype(np.float32)
        looks, weights = [], []
        for alone, pose in zip(self.alones, poses, strict=True):
            state = picture.level(pose)
            R, _ = rotation_with_derivatives(*state[3:])
            seen = project(picture.camera, picture.view, points @ R.T + state[:3])
            seen = seen.reshape(*shape, 2)
            weight = (sample(shown, seen) > 0.99)[..., None].astype(float)  # 0 outside, too
            look = sample(alone, seen) * weight
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
        """Move all exposures in their own frames so that the first is where it is known to be.

        Its error of alignment becomes that of the others; where it is unclear, all become None.
        The error of the known pose is not in their covariance.
        """
        first = found[0]
        if first is None or first.score < self.least_clear:
            return [None] * len(found)
        off = step_between(self.picture.known.planar, first.pose.planar)
        common = np.zeros((6, 6))
        common[np.ix_(PLANAR, PLANAR)] = first.pose.covariance[np.ix_(PLANAR, PLANAR)]
        moved: list[Alignment | None] = []
        for k, each in enumerate(found):
            if each is None:
                moved.append(None)
                continue
            pose = _moved(each.pose, stepped_back(each.pose.planar, off))
            covariance = pose.covariance + (common if k else 0.0)
            moved.append(replace(each, pose=replace(pose, covariance=covariance)))
        return moved

    def clear_or_rough(
        self, alignment: Alignment | None, pose: Array, slip: float, lever: float
    ) -> Alignment:
        """Return the alignment, with others' error added, if it is clear, else the raster's pose.

        Args:
            alignment: The alignment, or None where it failed.
            pose: Pose on the raster, shape (3,) [m, m, rad].
            slip: Standard deviation of position at equal power, in lengths of the robot [-].
            lever: Lever arm that converts it to heading, in lengths of the robot [-].
        """
        if alignment is None or alignment.score < self.least_clear:
            return self.picture.rough(pose)
        return self.picture.widened(alignment, slip, lever=lever)


def _score(alignment: Alignment | None) -> float:
    return 0.0 if alignment is None else alignment.score


def _nearer(pose: Array, alignment: Alignment | None, share: float) -> Array:
    if alignment is None:
        return pose
    return stepped(pose, share * step_between(pose, alignment.pose.planar))


def _moved(pose: BodyPose, planar: Array) -> BodyPose:
    state = pose.state.copy()
    state[PLANAR] = planar
    return replace(pose, state=state)
