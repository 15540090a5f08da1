# SPDX-License-Identifier: MIT
"""Bundle adjustment of camera poses and floor marks, with measured positions as a prior.

The unknowns are a camera pose for each stand (6) and x, y, yaw and side of every mark (x, y of a
point). Minimised is

    sum over stands and marks  r' C^-1 r  +  sum over marks  ((m - m_tape) / sd_tape)²

where r is the mark's pixels minus its projection, C the covariance of the pixels, m the unknowns of
a mark, and m_tape and sd_tape the same as measured with a tape measure and their standard
deviations. Measurements fix the frame: without them translation, rotation and scale of the floor
are undetermined. Where residuals are too large, each sum is divided by the square of a factor.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from tracking.camera.lens import Array, Camera, CameraPose, project, project_with_derivatives
from tracking.errors import FloorError
from tracking.floor.locate import FloorView, locate_camera, seen_keys
from tracking.floor.marks import FloorMap
from tracking.floor.stands import split_stands

_CHANCE = 0.95
"""Quantile of chi-squared below which a sum of squared residuals counts as chance [-]."""

_REWEIGHINGS = 5


@dataclass(frozen=True)
class Stand:
    """Consecutive photographs during which the camera did not move.

    Attributes:
        pose: Pose of the camera; its covariance includes the tape measure's errors.
        photos: Names of those photographs that show a mark of the floor, in order of time.
    """

    pose: CameraPose
    photos: tuple[str, ...]


@dataclass(frozen=True)
class FloorFit:
    """The floor and the camera, fitted to all photographs, with residual statistics.

    Attributes:
        floor: The map with refined x, y, yaw and side of the marks; marks that no photograph shows
            are as measured.
        stands: One entry for each stretch of photographs with the camera at rest.
        shifts: By key of each mark, x and y of its refined minus its measured centre, shape (2,)
            [m].
        misfit_px: Root mean square distance of the marks' points, medians over the photographs of
            a stand, from their projection [px].
        noise_factor: Pixel residuals over their standard deviations by the marks' covariances, 1
            where the excess is not significant; the poses' covariances include the factor [-].
        tape_factor: The same ratio, used likewise, of the marks' changes in x, y, yaw and side to
            the standard deviations of their measurement [-].
        unused: By name of photograph, why it has no camera pose: it shows no mark of the floor.
    """

    floor: FloorMap
    stands: tuple[Stand, ...]
    shifts: Mapping[int | str, Array]
    misfit_px: float
    noise_factor: float
    tape_factor: float
    unused: Mapping[str, str]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings, one sentence each: camera moved; mark shifted by more than 4 `position_sd`."""
        messages = [
            f"the camera moved between {a.photos[-1]} and {b.photos[0]}; photographs before and "
            f"after have different camera poses"
            for a, b in zip(self.stands, self.stands[1:], strict=False)
        ]
        for key, shift in self.shifts.items():
            sd = self.floor.marks[key].position_sd
            if np.linalg.norm(shift) > 4 * sd:
                messages.append(
                    f"mark {key} lies {1e3 * float(np.linalg.norm(shift)):.1f} mm from its place "
                    f"in floor.toml, over 4 times position_sd ({1e3 * sd:.1f} mm); measure it again"
                )
        return tuple(messages)

    def pose_of(self, photo: str) -> CameraPose:
        """Return the camera's pose in the stand of a photograph, by the photograph's name.

        Raises:
            FloorError: When the photograph shows no mark or was not among those fitted.
        """
        for stand in self.stands:
            if photo in stand.photos:
                return stand.pose
        raise FloorError(f"{photo}: {self.unused.get(photo, 'not among the photographs fitted')}")


def refine_floor(camera: Camera, floor: FloorMap, views: Sequence[FloorView]) -> FloorFit:
    """Fit camera poses and mark positions to all photographs at once (bundle adjustment).

    Args:
        camera: Camera intrinsics and distortion.
        floor: The map as measured with a tape measure.
        views: Pixels of the floor's marks in each photograph, in order of time.

    Returns:
        Refined map, a camera pose with covariance for each stand, residuals, unused photographs.

    Raises:
        FloorError: When no photograph shows a mark, or a stand fewer than 4 points, or the map
            does not fit one (see `locate_camera`).
    """
    usable = [view for view in views if seen_keys(floor, view)]
    unused = {view.photo: "no mark of the floor is seen" for view in views if view not in usable}
    if not usable:
        raise FloorError(
            f"none of the {len(views)} photographs shows a mark of the floor "
            f"({', '.join(map(str, floor.marks))}); check the numbers and dictionary "
            f"'{floor.dictionary}' in floor.toml, or click on points of the floor"
        )
    numbers = split_stands(usable)
    groups = [
        [view for view, number in zip(usable, numbers, strict=True) if number == index]
        for index in range(max(numbers) + 1)
    ]
    means = [_mean_view(group) for group in groups]
    starts = [locate_camera(camera, floor, view) for view in means]
    problem = _Problem(camera, floor, means)
    fitted, poses, covariance, misfit, factors = problem.solve(starts)
    stands = tuple(
        Stand(
            CameraPose(pose.rotation_vector, pose.translation, covariance[index]),
            tuple(view.photo for view in group),
        )
        for index, (pose, group) in enumerate(zip(poses, groups, strict=True))
    )
    shifts = {
        key: np.subtract(fitted.marks[key].points[:, :2].mean(0), mark.points[:, :2].mean(0))
        for key, mark in floor.marks.items()
    }
    return FloorFit(fitted, stands, shifts, misfit, *factors, unused)


def _mean_view(views: Sequence[FloorView]) -> FloorView:
    """Compute the median pixels and mean covariance of each mark over a stand's photographs.

    The view has the name of the first photograph.
    """
    pixels: dict[int | str, Array] = {}
    covariances: dict[int | str, Array] = {}
    for key in {key: None for view in views for key in view.pixels}:
        seen = [view for view in views if key in view.pixels]
        # The median is robust to a photograph in which the robot covers a corner. The covariance is
        # not divided by the number of photographs: errors of print and lens are common to all.
        pixels[key] = np.median([view.pixels[key] for view in seen], axis=0)
        covariances[key] = np.mean([view.covariances[key] for view in seen], axis=0)
    return FloorView(views[0].photo, pixels, covariances)


@dataclass(frozen=True)
class _Part:
    """Normal equations of one group of residuals: J'WJ, J'Wr, cost r'Wr and count of residuals.

    r is measured minus computed, J the derivative of what is computed by the unknowns, W the
    inverse covariance of r.
    """

    normal: Array
    gradient: Array
    cost: float
    count: int


def _weighed(parts: Sequence[Array], factors: Sequence[float]) -> Array:
    """Sum the matrices J'WJ or the vectors J'Wr of all groups, each divided by its factor²."""
    return np.sum([part / factor**2 for part, factor in zip(parts, factors, strict=True)], axis=0)


@dataclass(frozen=True)
class _Problem:
    camera: Camera
    floor: FloorMap
    views: Sequence[FloorView]

    def solve(
        self, starts: Sequence[CameraPose]
    ) -> tuple[FloorMap, list[CameraPose], list[Array], float, tuple[float, float]]:
        """Fit map and poses; refit with variances of pixels and measurements from residuals.

        Returns:
            Map, poses, their covariances (6, 6), root mean square distance of points [px], and
            the factors on the standard deviations of pixels and of tape measurements [-].
        """
        factors = (1.0, 1.0)
        floor, poses = self._least_squares(self.floor, list(starts), factors)
        parts = self._system(floor, poses)
        for _ in range(_REWEIGHINGS):
            before, factors = factors, self._factors(parts, factors)
            if np.allclose(factors, before, rtol=1e-2):
                break
            floor, poses = self._least_squares(floor, poses, factors)
            parts = self._system(floor, poses)
        covariance = np.linalg.inv(_weighed([part.normal for part in parts], factors))
        blocks = [covariance[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] for i in range(len(poses))]
        return floor, poses, blocks, float(np.sqrt(2 * self._squares(floor, poses))), factors

    def _least_squares(
        self, floor: FloorMap, poses: list[CameraPose], factors: tuple[float, float]
    ) -> tuple[FloorMap, list[CameraPose]]:
        """Refine map and poses by Gauss-Newton, at most 20 steps, with fixed factors."""
        for _ in range(20):
            parts = self._system(floor, poses)
            gradient = _weighed([part.gradient for part in parts], factors)
            step = np.linalg.solve(_weighed([part.normal for part in parts], factors), gradient)
            floor, poses = self._moved(floor, poses, step)
            if step @ gradient < 1e-10 * max(sum(part.cost for part in parts), 1.0):
                break
        return floor, poses

    def _factors(
        self, parts: Sequence["_Part"], factors: tuple[float, float]
    ) -> tuple[float, float]:
        """Estimate factors, at least 1, on standard deviations of pixels and tape measurements.

        Variance components (Helmert 1907; Koch 1999, section 3.6): with N the normal equations of
        all and N_g those of one group, its n_g residuals have r_g = n_g - tr(N^-1 N_g) degrees of
        freedom, the expectation of their sum of squares. A factor is 1 up to the 95 % point of
        that sum's distribution, and where r_g <= 0.5. One factor for both would attribute the error
        of a poor picture to the tape measurements, and widen every camera pose's covariance.
        """
        inverse = np.linalg.inv(_weighed([part.normal for part in parts], factors))
        found = []
        for part, factor in zip(parts, factors, strict=True):
            freedom = part.count - float(np.sum(inverse * part.normal)) / factor**2
            chance = chi2.ppf(_CHANCE, freedom) if freedom > 0.5 else np.inf
            found.append(float(np.sqrt(part.cost / freedom)) if part.cost > chance else 1.0)
        return found[0], found[1]

    def _slots(self) -> dict[int | str, slice]:
        start, slots = 6 * len(self.views), {}
        for key, mark in self.floor.marks.items():
            slots[key] = slice(start, start + len(mark.prior_sd))
            start += len(mark.prior_sd)
        return slots

    def _system(self, floor: FloorMap, poses: Sequence[CameraPose]) -> tuple["_Part", "_Part"]:
        """Compute the normal equations of the pixel residuals and of the tape measurements."""
        return self._by_pixels(floor, poses), self._by_tape(floor)

    def _by_pixels(self, floor: FloorMap, poses: Sequence[CameraPose]) -> "_Part":
        slots, size = self._slots(), self._size
        normal, gradient, cost, count = np.zeros((size, size)), np.zeros(size), 0.0, 0
        for index, (pose, view) in enumerate(zip(poses, self.views, strict=True)):
            for key in seen_keys(floor, view):
                mark = floor.marks[key]
                pixels, by_point, by_pose = project_with_derivatives(self.camera, pose, mark.points)
                J = np.zeros((2 * len(pixels), size))
                J[:, 6 * index : 6 * index + 6] = by_pose.reshape(-1, 6)
                J[:, slots[key]] = (by_point @ mark.derivative).reshape(2 * len(pixels), -1)
                r = (view.pixels[key] - pixels).ravel()
                weight = np.linalg.inv(view.covariances[key])
                normal += J.T @ weight @ J
                gradient += J.T @ weight @ r
                cost += float(r @ weight @ r)
                count += len(r)
        return _Part(normal, gradient, cost, count)

    def _by_tape(self, floor: FloorMap) -> "_Part":
        size = self._size
        normal, gradient, cost, count = np.zeros((size, size)), np.zeros(size), 0.0, 0
        for key, slot in self._slots().items():
            weight = self.floor.marks[key].prior_sd ** -2
            pull = self._from_tape(floor, key)
            normal[slot, slot] += np.diag(weight)
            gradient[slot] -= weight * pull
            cost += float(weight @ pull**2)
            count += len(pull)
        return _Part(normal, gradient, cost, count)

    def _squares(self, floor: FloorMap, poses: Sequence[CameraPose]) -> float:
        """Compute the mean squared residual per pixel coordinate, all marks and stands [px²]."""
        residuals = [
            view.pixels[key] - project(self.camera, pose, floor.marks[key].points)
            for pose, view in zip(poses, self.views, strict=True)
            for key in seen_keys(floor, view)
        ]
        return float(np.mean(np.concatenate(residuals) ** 2))

    @property
    def _size(self) -> int:
        return max(slot.stop for slot in self._slots().values())

    def _from_tape(self, floor: FloorMap, key: int | str) -> Array:
        found, tape = floor.marks[key], self.floor.marks[key]
        names = ("x", "y", "yaw", "side")[: len(tape.prior_sd)]
        return np.array([getattr(found, name) - getattr(tape, name) for name in names])

    def _moved(
        self, floor: FloorMap, poses: Sequence[CameraPose], step: Array
    ) -> tuple[FloorMap, list[CameraPose]]:
        marks = {key: floor.marks[key].moved(step[slot]) for key, slot in self._slots().items()}
        moved = [
            CameraPose(
                pose.rotation_vector + step[6 * i : 6 * i + 3],
                pose.translation + step[6 * i + 3 : 6 * i + 6],
                pose.covariance,
            )
            for i, pose in enumerate(poses)
        ]
        return floor.with_marks(marks), moved
