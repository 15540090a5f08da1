# SPDX-License-Identifier: MIT
"""Find every exposure of a robot without a marker, by how one of them looks.

Nothing in a picture says how it was merged. It is read in three ways (`mean`, `darkest`,
`pasted`), and the reading that finds most is taken; but of a mean all must be faint. Each reading
finds places on a raster; they are then aligned in the photograph by what the reading says is to be
seen of each.
"""

from collections.abc import Sequence
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
from tracking.composite.chain import step_between, stepped, stepped_back, usual_step
from tracking.composite.colours import FloorColours
from tracking.composite.darkest import DarkestReading
from tracking.composite.exposure import Exposure
from tracking.composite.mean import SCALE, Fit, MeanReading
from tracking.composite.pasted import FLOOR_LEFT, LEFT, PastedReading
from tracking.composite.plane import Plane
from tracking.errors import BodyError, CompositeError
from tracking.pose import BodyPose, BodyPrior, rotation_with_derivatives

LEAST_SCORE = 0.75
"""Least correlation of what is visible of an exposure with the known one [-]."""

LEAST_CLEAR_SCORE, LEAST_FAINT_SCORE = 0.4, 0.2
"""The same of the edges of an exposure in a mean: to be aligned by them, and not to be astray."""

MOST_ODD = 2.5
"""Points of a pasted exposure that differ by more usual differences are of something else [-]."""

RASTER_SD = 0.02
"""Standard deviation of a place on the raster, in lengths of the robot [-]."""

PASTED_SD, DARKEST_SD, MEAN_SD, MEAN_OVERLAP_SD = 1 / 300, 1 / 40, 1 / 700, 1 / 220
"""Error of a place where others show as much as the robot does, in lengths of the robot; of pasted
ones of which all shows. It grows with the root of their power, (1 - score²) / score², and was
chosen by 390 exposures of simulated walks that no test draws [-]."""

MEAN_EDGE_SD = 1 / 80
"""The same in a mean of a plain top that is placed by its edges; chosen by the one walk that has
one, the virtual world's [-]."""

_CELLS = {"pasted": 40, "darkest": 32, "mean": 32}
_AROUND = 0.28  # of the length: how far sides, legs and shadow reach
_EDGE = 0.035  # of the top's length: left out where it has a pattern
_MEAN_ROUNDS = 2
_SLIP = 0.06  # of the length: an alignment that ends farther off has gone astray
_TURN = 0.15  # rad: the same
_LEVER, _STRIP_LEVER, _HALF_LEVER = 0.7, 0.58, 0.5  # of the length: that much off there turns it
_LEAST_SHARE = 0.05
_PLANAR = [0, 1, 5]  # x, y and yaw in a state


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
class Likeness:
    """A picture in which one exposure is known, and others are sought that look like it.

    Attributes:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: The lens.
        view: Where the camera stood.
        prior: Height and tilt.
        known: Pose of the known exposure.
        plate: The robot's flat top.
        size: Length and width of its body [m].
        hidden: Pixels that do not show the robot, shape (height, width).
        area: Lowest and highest x, y of the body's middle, each of shape (2,) [m].
    """

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
        """Read the picture in each way; return what is found by the one that finds most."""
        anchor = self.known.planar
        self.body_template(self.pixels)  # cut by an edge or too faint: said before the search
        reading, pasted = self.find_pasted()
        darkest = self.darkest.find(anchor)
        mean = self.mean.find(anchor)
        most = max(len(pasted), len(darkest))
        if len(mean.poses) > 1 and len(mean.poses) >= most and self.mean.is_possible(mean):
            return self.aligned_in_mean(mean)
        if len(darkest) > len(pasted):
            return self.aligned_in_darkest(darkest)
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

    def template(self, pixels: NDArray, plate: TopPlate) -> BodyTemplate:
        """Cut a part of the robot out of the known exposure."""
        try:
            return make_template(pixels, self.camera, self.view, pose=self.known, plate=plate)
        except BodyError as error:
            raise CompositeError(str(error)) from error

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
                widened = self.widened(alignment, DARKEST_SD, lever=_LEVER)
                found.append(Exposure(widened, self.share(pose, visible)))
        return tuple(found)

    def aligned_in_mean(self, fit: Fit) -> tuple[Exposure, ...]:
        """Align each with what the others leave of the picture, by edges alone."""
        reading, fine = self.mean, self.fine_weighing
        weighed = self.pixels.astype(np.float32) @ fine
        weighed_again = np.linalg.inv(reading.weighing) @ fine

        def alone(k: int) -> NDArray[np.float32]:
            others = reading.sum_of(np.delete(fit.poses, k, axis=0), fit.robot)
            seen = self.on_photo(others, reading.plane, fit.poses[k])
            return (weighed - seen @ weighed_again).astype(np.float32)

        alones = [alone(k) for k in range(len(fit.poses))]
        if usual_step(fit.poses) < self.size[0]:
            return self.aligned_that_overlap(alones, fit.poses)
        return self.aligned_apart(alones, fit.poses)

    def aligned_apart(
        self, alones: Sequence[NDArray[np.float32]], poses: Array
    ) -> tuple[Exposure, ...]:
        """Align by the pattern of the top; where that says little, by the edges of the top.

        What is around the top lies lower and shifts against it from one place to the next.
        """
        inside = -_EDGE * self.plate.length
        within = replace(self.plate, margin=inside, front_margin=inside)
        found, slip = self.aligned_with_mean(alones, poses, within), MEAN_SD
        if np.median([_score(each) for each in found[1:]]) < LEAST_CLEAR_SCORE:
            found, slip = self.aligned_with_mean(alones, poses, self.plate), MEAN_EDGE_SD
        return tuple(
            Exposure(self.clear_or_rough(each, pose, slip, _LEVER), 1.0)
            for each, pose in zip(found, poses, strict=True)
        )

    def aligned_that_overlap(
        self, alones: Sequence[NDArray[np.float32]], poses: Array
    ) -> tuple[Exposure, ...]:
        """Align the body; one but the known whose edges say little is none.

        If those of the known one say nothing, the others cannot be judged and stay on the raster.
        """
        body = TopPlate(*self.size, self.plate.height, 0.0, 0.0, 0.0)
        found = self.aligned_with_mean(alones, poses, body)
        return tuple(
            Exposure(self.clear_or_rough(each, pose, MEAN_OVERLAP_SD, _HALF_LEVER), 1.0)
            for k, (each, pose) in enumerate(zip(found, poses, strict=True))
            if k == 0 or found[0] is None or _score(each) >= LEAST_CLEAR_SCORE
        )

    def aligned_with_mean(
        self, alones: Sequence[NDArray[np.float32]], poses: Array, plate: TopPlate
    ) -> list[Alignment | None]:
        """Align a part of the robot with its mean in the others; None of what goes astray."""
        share = (len(poses) - 1) / len(poses)
        found: list[Alignment | None] = []
        for _ in range(_MEAN_ROUNDS):
            templates = self.others_templates(alones, poses, plate)
            found = self.anchored([
                self.aligned(pose, alone, template, ~self.hidden, least=LEAST_FAINT_SCORE,
                             shines_through=True)
                for pose, alone, template in zip(poses, alones, templates, strict=True)
            ])  # fmt: skip
            # The others err, too: n exposures come nearest by that share of the way.
            poses = np.array([
                pose
                if each is None
                else stepped(pose, share * step_between(pose, each.pose.planar))
                for each, pose in zip(found, poses, strict=True)
            ])  # fmt: skip
        return [
            each and replace(each, pose=_moved(each.pose, pose))
            for each, pose in zip(found, poses, strict=True)
        ]

    def others_templates(
        self, alones: Sequence[NDArray[np.float32]], poses: Array, plate: TopPlate
    ) -> list[BodyTemplate]:
        """Cut a part of the robot out of all exposures; for each take the mean of the others.

        The mean of all would hold an exposure where it is, and look like it.
        """
        first = self.template(alones[0], plate)
        shape, points = first.points_body.shape[:2], first.points_body.reshape(-1, 3)
        shown = (~self.hidden).astype(np.float32)
        looks, weights = [], []
        for alone, pose in zip(alones, poses, strict=True):
            state = self.level(pose)
            R, _ = rotation_with_derivatives(*state[3:])
            seen = project(self.camera, self.view, points @ R.T + state[:3]).reshape(*shape, 2)
            weight = (sample(shown, seen) > 0.99)[..., None].astype(float)  # 0 outside, too
            look = sample(alone, seen) * weight
            usual = look.sum(axis=(0, 1)) / max(float(weight.sum()), 1.0)
            looks.append(look - usual * weight)
            weights.append(weight)
        total, count = np.sum(looks, axis=0), np.sum(weights, axis=0)
        return [
            replace(
                first, colours=((total - look) / np.maximum(count - weight, 1)).astype(np.float32)
            )
            for look, weight in zip(looks, weights, strict=True)
        ]

    def anchored(self, found: Sequence[Alignment | None]) -> list[Alignment | None]:
        """Move all exposures in their own frames so that the first is where it is known to be.

        Its error of alignment becomes that of the others; where it is unclear none can be judged.
        What is wrong with the pose that is known is not in their covariance.
        """
        first = found[0]
        if first is None or first.score < LEAST_CLEAR_SCORE:
            return [None] * len(found)
        off = step_between(self.known.planar, first.pose.planar)
        common = np.zeros((6, 6))
        common[np.ix_(_PLANAR, _PLANAR)] = first.pose.covariance[np.ix_(_PLANAR, _PLANAR)]
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
        """Take an alignment where it is clear, else the place on the raster."""
        if alignment is None or alignment.score < LEAST_CLEAR_SCORE:
            return self.rough(pose)
        return self.widened(alignment, slip, lever=lever)

    @property
    def fine_weighing(self) -> Array:
        """Matrix that makes the floor's fine pattern scatter alike in all colours, shape (3, 3).

        Lenses and JPEG spare fine colour more than fine light.
        """
        width = SLOW * self.size[0] / self.body_template(self.pixels).step
        picture = self.pixels.astype(np.float32)
        floor = FloorColours.of(picture, ~self.hidden, width=width, noise=0.5)
        return (SCALE * floor.whitening).astype(np.float32)

    def share(self, pose: Array, visible: NDArray[np.bool_]) -> float:
        """Compute the share of an exposure's top that is visible."""
        top = self.box.top_seen(self.level(pose))
        return float((top & visible).sum() / max(int(top.sum()), 1))

    def level(self, pose: Array) -> Array:
        """Stand the robot level at x, y and yaw; its state, shape (6,)."""
        return np.array([pose[0], pose[1], self.prior.height, 0.0, 0.0, pose[2]])

    def aligned(
        self, pose: Array, pixels: NDArray, template: BodyTemplate, visible: NDArray[np.bool_], *,
        least: float, shines_through: bool = False, most_odd: float = np.inf,
    ) -> Alignment | None:  # fmt: skip
        """Align one exposure; None where that goes astray."""
        found = align(
            pixels, self.camera, self.view, template=template, prior=self.prior, start=pose,
            visible=visible, blurs_px=(1.0,), least_visible=0.0, least_hope=-1.0,
            shines_through=shines_through, most_odd=most_odd,
        )  # fmt: skip
        return None if found is None or self.is_astray(found, pose, least) else found

    def is_astray(self, found: Alignment, pose: Array, least: float) -> bool:
        """Tell whether an alignment is too far from where it began, or too unlike the robot."""
        aligned = found.pose.planar
        turned = abs(float(np.angle(np.exp(1j * (aligned[2] - pose[2])))))
        away = float(np.hypot(*(aligned[:2] - pose[:2])))
        return found.score < least or away > _SLIP * self.size[0] or turned > _TURN

    def widened(self, alignment: Alignment, slip: float, *, lever: float) -> Alignment:
        """Add what others do to the place and the heading of an exposure, by their power."""
        power = max(1 - alignment.score**2, 0.0) / alignment.score**2
        added = self.slipped(slip * self.size[0] * float(np.sqrt(power)), lever)
        pose = alignment.pose
        return replace(alignment, pose=replace(pose, covariance=pose.covariance + added))

    def rough(self, pose: Array) -> Alignment:
        """Take a place on the raster for the alignment."""
        height, tilt = self.prior.height_sd, self.prior.tilt_sd
        known = np.diag([0.0, 0.0, height, tilt, tilt, 0.0]) ** 2
        covariance = known + self.slipped(RASTER_SD * self.size[0], _LEVER)
        state = self.level(pose)
        return Alignment(BodyPose(state, covariance, np.zeros((6, 6)), 0.0, 0.0), 0.0, 0.0)

    def slipped(self, slip: float, lever: float) -> Array:
        """Compute the covariance of a place that slipped by so much at a lever, shape (6, 6)."""
        turn = slip / (lever * self.size[0])
        return np.diag([slip, slip, 0.0, 0.0, 0.0, turn]) ** 2

    def on_photo(
        self, layer: NDArray, plane: Plane, pose: Array, *, reach: float = 0.75
    ) -> NDArray[np.float32]:
        """Read a layer of a plane at the pixels around an exposure; 0 beyond so many diagonals."""
        reach *= float(np.hypot(*self.size))
        height = self.prior.height + self.plate.height
        sides = np.array([-reach, reach])
        around = [[pose[0] + dx, pose[1] + dy, height] for dx in sides for dy in sides]
        seen = project(self.camera, self.view, np.array(around))
        low = np.clip(np.floor(seen.min(axis=0)).astype(int), 0, self.camera.size)
        high = np.clip(np.ceil(seen.max(axis=0)).astype(int) + 1, low, self.camera.size)
        u, v = np.meshgrid(np.arange(low[0], high[0]), np.arange(low[1], high[1]))
        whole = np.zeros((*self.pixels.shape[:2], *layer.shape[2:]), np.float32)
        if u.size == 0:
            return whole
        pixels = np.stack((u, v), axis=-1).reshape(-1, 2).astype(float)
        xy = to_floor(self.camera, self.view, pixels, height)
        place = np.column_stack((xy[:, 0] - plane.low[0], plane.high[1] - xy[:, 1])) / plane.cell
        values = sample(layer.astype(np.float32), place.reshape(*u.shape, 2))
        whole[low[1] : high[1], low[0] : high[0]] = values
        return whole


def _score(alignment: Alignment | None) -> float:
    return 0.0 if alignment is None else alignment.score


def _moved(pose: BodyPose, planar: Array) -> BodyPose:
    state = pose.state.copy()
    state[_PLANAR] = planar
    return replace(pose, state=state)
