# SPDX-License-Identifier: MIT
"""Bundle adjustment of camera poses, floor marks, lens and edges, with what is known as a prior.

The unknowns are a camera pose for each stand (6); x, y, yaw and side of every mark (x, y of a
point); the lens, within the covariance of its calibration; and how far the edges of all markers lie
outwards in the picture. Minimised is

    sum over stands and marks  r' C^-1 r  +  sum over marks  ((m - m_tape) / sd_tape)²
        +  l' P^-1 l  +  (b / s)²

where r is the mark's pixels minus its projection, C the covariance of the pixels, m the unknowns of
a mark, m_tape and sd_tape the same as measured with a tape measure and their standard deviations,
l the lens less its calibration and P the covariance of that, b the edges and s their spread.
Tape measurements alone fix translation, rotation and scale of the floor. Where residuals are too
large, the first two sums are divided by the square of a factor each.

Edges: sharpening, exposure, compression and resampling move the border between black and white by
up to some tenths of a pixel. A marker then looks larger or smaller than it is, and nearer or
farther. The edges of all markers move alike by b, which has a part that is the same everywhere and
one that grows with the logarithm of the distance; those of each marker move by more: C contains s²
along the growth of the marker. s is found from the sizes in which the floor's markers appear.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.stats import chi2

from model.arrays import Array
from tracking.camera.lens import Camera, CameraPose, project_with_derivatives
from tracking.floor.edge_spread import EDGE_SCALE, EDGE_SPREADS, EdgeSpread
from tracking.floor.locate import FloorView, seen_keys
from tracking.floor.marks import FloorMap
from tracking.markers import edge_growth
from tracking.shared import EDGES, LENS, SharedErrors, mark_name, stand_name

_CHANCE = 0.95  # quantile of chi-squared below which a sum of squared residuals counts as chance
_REWEIGHINGS = 5  # largest number of refits with new variances
EDGE_REACH = 0.3
"""Logarithm of distance over which the common error of edges changes as much as it is large [-]."""


@dataclass(frozen=True)
class Adjusted:
    """Values of the unknowns.

    Attributes:
        floor: The map with its marks' x, y, yaw and side.
        poses: Pose of the camera in each stand.
        lens: fx, fy, cx, cy, k1, k2, p1, p2, k3 less the calibration's, in units of the columns of
            its root, shape (r,) [-].
        edges: How far the edges of all markers lie outwards: at the mean distance of the floor's
            marks, and more for each `EDGE_REACH` of the logarithm of distance, shape (2,) [px].
    """

    floor: FloorMap
    poses: tuple[CameraPose, ...]
    lens: Array
    edges: Array


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
class Adjustment:
    """The least-squares problem.

    Attributes:
        camera: Camera intrinsics and distortion, with covariance.
        floor: The map as measured with a tape measure.
        views: Pixels of the floor's marks in each stand.
        poses: Poses of the camera in each stand to start from.
        edge_sd: Spread of the edges [px].
    """

    camera: Camera
    floor: FloorMap
    views: Sequence[FloorView]
    poses: Sequence[CameraPose]
    edge_sd: float = 0.0

    def solve(self) -> tuple[Adjusted, tuple[float, float]]:
        """Fit all unknowns; refit with variances of pixels and measurements from residuals.

        Returns:
            The unknowns, and the factors on the standard deviations of pixels and of tape
            measurements [-].
        """
        factors = (1.0, 1.0)
        found = self.fitted(self.start(), factors)
        for _ in range(_REWEIGHINGS):
            before, factors = factors, self._factors(self._system(found), factors)
            if np.allclose(factors, before, rtol=1e-2):
                break
            found = self.fitted(found, factors)
        return found, factors

    def edges(self) -> "EdgeSpread":
        """Compute the posterior of the edges' spread by the evidence (marginal likelihood) of each.

        The prior is half-Cauchy, of scale `EDGE_SCALE`, and is returned where the floor has no
        markers: a few can tell a large spread from a small one, hardly more.
        """
        prior = np.log(EDGE_SPREADS) - np.log1p((EDGE_SPREADS / EDGE_SCALE) ** 2)  # by log spread
        if not self.floor.markers:
            return EdgeSpread(prior)
        logs, found = [], self.start()
        for sd in EDGE_SPREADS:
            problem = replace(self, edge_sd=float(sd))
            found = problem.fitted(found)
            logs.append(problem.log_evidence(found))
        return EdgeSpread(prior + np.array(logs))

    def shared_errors(self, found: Adjusted, factors: tuple[float, float]) -> SharedErrors:
        """Compute the joint covariance of lens, camera poses, marks and edges at the solution."""
        parts = self._system(found)
        covariance = np.linalg.inv(_weighed([part.normal for part in parts], (*factors, 1.0)))
        root = self._lens_root
        size, own = self._size, self._lens_slot
        whole = np.zeros((size + 9 - root.shape[1], size))
        slots = {stand_name(k): slice(6 * k, 6 * k + 6) for k in range(len(self.views))}
        slots |= {mark_name(key): slot for key, slot in self._mark_slots.items()}
        whole[: own.start, : own.start] = np.eye(own.start)
        whole[own.start : own.start + 9, own] = root  # from r unknowns to 9 parameters of the lens
        whole[-2:, -2:] = np.eye(2)
        slots |= {LENS: slice(own.start, own.start + 9), EDGES: slice(own.start + 9, len(whole))}
        return SharedErrors(whole @ covariance @ whole.T, slots)

    def misfit(self, found: Adjusted) -> float:
        """Compute the root mean square distance of the marks' points from their projection [px]."""
        residuals = [
            residual
            for view, pose in zip(self.views, found.poses, strict=True)
            for _, residual, _ in self._residuals(found, view, pose, 0)
        ]
        return float(np.sqrt(2 * np.mean(np.concatenate(residuals) ** 2)))

    def lens(self, found: Adjusted) -> Camera:
        """Return the camera with the lens's unknowns added to its calibration."""
        return self.camera.changed(self._lens_root @ found.lens)

    def start(self) -> Adjusted:
        """Return starting values: marks as measured, `poses`, and no change of lens and edges."""
        return Adjusted(
            self.floor, tuple(self.poses), np.zeros(self._lens_root.shape[1]), np.zeros(2)
        )

    def fitted(self, found: Adjusted, factors: tuple[float, float] = (1.0, 1.0)) -> Adjusted:
        """Refine the unknowns by Gauss-Newton, at most 20 steps.

        Args:
            found: Where to start.
            factors: Factors on the standard deviations of pixels and of tape measurements [-].
        """
        for _ in range(20):
            parts = self._system(found)
            scales = (*factors, 1.0)
            gradient = _weighed([part.gradient for part in parts], scales)
            step = np.linalg.solve(_weighed([part.normal for part in parts], scales), gradient)
            found = self._moved(found, step)
            if step @ gradient < 1e-10 * max(sum(part.cost for part in parts), 1.0):
                break
        return found

    def log_evidence(self, found: Adjusted) -> float:
        """Compute the log marginal likelihood (Laplace) of the pixels, up to a constant."""
        parts = self._system(found)
        normal = _weighed([part.normal for part in parts], (1.0, 1.0, 1.0))
        noise = -sum(float(np.linalg.slogdet(each)[1]) for each in self._pixel_weights.values())
        cost = sum(part.cost for part in parts)
        prior = sum(float(np.log(mark.prior_sd).sum()) for mark in self.floor.marks.values())
        prior += 2 * np.log(max(self.edge_sd, 1e-6))
        return -0.5 * (cost + float(np.linalg.slogdet(normal)[1]) + noise) - prior

    def _factors(self, parts: Sequence[_Part], factors: tuple[float, float]) -> tuple[float, float]:
        """Estimate factors, at least 1, on standard deviations of pixels and tape measurements.

        Variance components (Helmert 1907; Koch 1999, section 3.6): with N the normal equations of
        all and N_g those of one group, its n_g residuals have r_g = n_g - tr(N^-1 N_g) degrees of
        freedom, the expectation of their sum of squares. A factor is 1 up to the 95 % point of
        that sum's distribution, and where r_g <= 0.5. One factor for both would attribute the error
        of a poor picture to the tape measurements, and widen every camera pose's covariance.
        """
        inverse = np.linalg.inv(_weighed([part.normal for part in parts], (*factors, 1.0)))
        found = []
        for part, factor in zip(parts[:2], factors, strict=True):
            freedom = part.count - float(np.sum(inverse * part.normal)) / factor**2
            chance = chi2.ppf(_CHANCE, freedom) if freedom > 0.5 else np.inf
            found.append(float(np.sqrt(part.cost / freedom)) if part.cost > chance else 1.0)
        return found[0], found[1]

    @cached_property
    def _lens_root(self) -> Array:
        """Matrix A, shape (9, r), with A A' the covariance of the lens."""
        return SharedErrors(self.camera.covariance, {}).root

    @cached_property
    def _mark_slots(self) -> dict[int | str, slice]:
        """Columns of each mark's unknowns among all: after 6 of each stand, in the map's order."""
        start, slots = 6 * len(self.views), {}
        for key, mark in self.floor.marks.items():
            slots[key] = slice(start, start + len(mark.prior_sd))
            start += len(mark.prior_sd)
        return slots

    @property
    def _lens_slot(self) -> slice:
        """Columns of the lens's unknowns among all: after those of the marks."""
        start = max(slot.stop for slot in self._mark_slots.values())
        return slice(start, start + self._lens_root.shape[1])

    @property
    def _size(self) -> int:  # number of unknowns; the last two are those of the edges
        return self._lens_slot.stop + 2

    def _system(self, found: Adjusted) -> tuple["_Part", "_Part", "_Part"]:
        """Compute the normal equations of pixels, tape measurements, and of lens and edges."""
        return self._by_pixels(found), self._by_tape(found.floor), self._by_prior(found)

    def _by_pixels(self, found: Adjusted) -> "_Part":
        """Compute the normal equations of the pixels of all marks in all stands."""
        size = self._size
        normal, gradient, cost, count = np.zeros((size, size)), np.zeros(size), 0.0, 0
        for index, (pose, view) in enumerate(zip(found.poses, self.views, strict=True)):
            for key, r, J in self._residuals(found, view, pose, index):
                weight = self._pixel_weights[index, key]
                normal += J.T @ weight @ J
                gradient += J.T @ weight @ r
                cost += float(r @ weight @ r)
                count += len(r)
        return _Part(normal, gradient, cost, count)

    def _residuals(
        self, found: Adjusted, view: FloorView, pose: CameraPose, index: int
    ) -> list[tuple[int | str, Array, Array]]:
        """Compute for each mark its residual (2n,) and the Jacobian (2n, size) of its pixels."""
        camera, slots, root = self.lens(found), self._mark_slots, self._lens_root
        computed = []
        for key in seen_keys(self.floor, view):
            mark = found.floor.marks[key]
            seen = project_with_derivatives(camera, pose, mark.points)
            J = np.zeros((2 * len(seen.pixels), self._size))
            J[:, 6 * index : 6 * index + 6] = seen.by_pose.reshape(-1, 6)
            J[:, slots[key]] = (seen.by_point @ mark.derivative).reshape(len(J), -1)
            J[:, self._lens_slot] = seen.by_lens.reshape(-1, 9) @ root
            drawn = seen.pixels
            if len(drawn) == 4:
                by_edges = self.edge_derivative(view.pixels[key], mark.points, pose)
                J[:, -2:] = by_edges.reshape(-1, 2)
                drawn = drawn + by_edges @ found.edges
            computed.append((key, (view.pixels[key] - drawn).ravel(), J))
        return computed

    def edge_derivative(self, corners_px: Array, points: Array, pose: CameraPose) -> Array:
        """Compute how the common errors of edges move the corners of a marker, shape (4, 2, 2).

        Args:
            corners_px: Corners of the marker, shape (4, 2) [px].
            points: The same in the floor frame, shape (4, 3) [m].
            pose: Pose of the camera.
        """
        away = float(np.log(np.linalg.norm(points.mean(axis=0) - pose.position)))
        along = (away - self.usual_distance) / EDGE_REACH
        return edge_growth(corners_px)[:, :, None] * [1.0, along]

    @cached_property
    def usual_distance(self) -> float:
        """Mean logarithm of the distance from the cameras at `poses` to the marks as measured."""
        logs = [
            np.log(np.linalg.norm(self.floor.marks[key].points.mean(axis=0) - pose.position))
            for view, pose in zip(self.views, self.poses, strict=True)
            for key in seen_keys(self.floor, view)
        ]
        return float(np.mean(logs))

    @cached_property
    def _pixel_weights(self) -> dict[tuple[int, int | str], Array]:
        """Inverse covariance of the pixels by number of the view and key of the mark."""
        weights = {}
        for index, view in enumerate(self.views):
            for key in seen_keys(self.floor, view):
                covariance = view.covariances[key]
                if len(view.pixels[key]) == 4:
                    growth = edge_growth(view.pixels[key]).ravel()
                    covariance = covariance + self.edge_sd**2 * np.outer(growth, growth)
                weights[index, key] = np.linalg.inv(covariance)
        return weights

    def _by_tape(self, floor: FloorMap) -> "_Part":
        """Compute the normal equations of the marks' differences from their measurement."""
        size = self._size
        normal, gradient, cost, count = np.zeros((size, size)), np.zeros(size), 0.0, 0
        for key, slot in self._mark_slots.items():
            weight = self.floor.marks[key].prior_sd ** -2
            pull = self._from_tape(floor, key)
            normal[slot, slot] += np.diag(weight)
            gradient[slot] -= weight * pull
            cost += float(weight @ pull**2)
            count += len(pull)
        return _Part(normal, gradient, cost, count)

    def _by_prior(self, found: Adjusted) -> "_Part":
        """Compute the normal equations of the priors of the lens and of the common edges."""
        size, slot = self._size, self._lens_slot
        normal, gradient = np.zeros((size, size)), np.zeros(size)
        normal[slot, slot] = np.eye(slot.stop - slot.start)
        gradient[slot] = -found.lens
        # Without a spread the edges are where they should be; the weight holds them there.
        weight = max(self.edge_sd, 1e-6) ** -2
        normal[-2:, -2:], gradient[-2:] = weight * np.eye(2), -weight * found.edges
        cost = float(found.lens @ found.lens + weight * found.edges @ found.edges)
        return _Part(normal, gradient, cost, slot.stop - slot.start + 2)

    def _from_tape(self, floor: FloorMap, key: int | str) -> Array:
        """Compute a mark's x, y, yaw and side (x, y of a point) less those measured with a tape."""
        found, tape = floor.marks[key], self.floor.marks[key]
        names = ("x", "y", "yaw", "side")[: len(tape.prior_sd)]
        return np.array([getattr(found, name) - getattr(tape, name) for name in names])

    def _moved(self, found: Adjusted, step: Array) -> Adjusted:
        """Return the unknowns with a step (size,) added."""
        marks = {
            key: found.floor.marks[key].moved(step[slot]) for key, slot in self._mark_slots.items()
        }
        by_stand = step[: 6 * len(found.poses)].reshape(-1, 2, 3)
        poses = [
            CameraPose(pose.rotation_vector + turn, pose.translation + shift, pose.covariance)
            for pose, (turn, shift) in zip(found.poses, by_stand, strict=True)
        ]
        lens, edges = found.lens + step[self._lens_slot], found.edges + step[-2:]
        return Adjusted(found.floor.with_marks(marks), tuple(poses), lens, edges)
