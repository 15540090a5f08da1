# SPDX-License-Identifier: MIT
"""Find exposures in a picture that is the mean of several exposures.

Of n exposures each is as faint as 1/n, and the floor's pattern is as strong as the robot. But
floors vary in brightness more than in colour, and robots do not. Colours are therefore whitened by
the floor's covariance (`FloorColours.whitening`). A mean is a sum: the robot's picture is solved
for, by least squares, so that its sum over all exposures is nearest to the photograph. Each
exposure is then compared with the residual of the others.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.composite.colours import SCALE, FloorColours, smooth
from tracking.composite.exposure import Exposure
from tracking.composite.match import Match, match_whole
from tracking.composite.mean_alignment import MeanAlignment, fine_whitening, floor_pattern
from tracking.composite.reading import Reading
from tracking.composite.steps import (
    CLIMB,
    LEAST_STEP,
    MOST_EXPOSURES,
    REACH,
    are_apart,
    distances,
    headed,
    improved,
    is_apart,
    is_beside,
    shifted_sets,
    usual_step,
)
from tracking.composite.superposition import solve_robot, superposed

LONELY_SCORE = 0.6
"""Least correlation of an exposure without a neighbour, or with reversed heading, among the
candidates [-]."""

BESIDE_SCORE = 0.5
"""Least correlation of an exposure with the known one for the first set of exposures [-]."""

LEAST_SCORE, LEAST_OF_USUAL = 0.5, 0.75
"""Least correlation of an exposure with the robot's picture after all others are subtracted, and
least share of the median correlation, which is lower on uneven light or strong floors [-]."""

LEAST_STRENGTH = 0.5
"""Least strength of an exposure relative to the robot's picture; 1 is expected in a mean [-]."""

WORTH = 0.4
"""Cost of one more exposure, as a share of the power of the robot's picture alone [-]."""

DETAIL = 1 / 4
"""Width of the high-pass filter for comparison, in lengths of the robot [-]."""

_ROUNDS = 30
_TRIED = 3
_LEAST_MATCH = 0.4
_BETTER = 1e-3  # share of the picture's power


class Fit(NamedTuple):
    """Fitted poses and picture of the robot, with goodness of fit.

    Attributes:
        poses: x, y [m] and yaw [rad] of the exposures, the known one first, shape (n, 3).
        robot: The robot's high-pass filtered picture on its raster, shape (rows, columns, 3).
        scores: Correlation of each exposure with `robot` after the other exposures are subtracted,
            1 for the known one, shape (n,) [-].
        strengths: Regression coefficient of each exposure on `robot`, likewise, shape (n,) [-].
        explained: Share of the picture's high-pass filtered power that the exposures explain [-].
        cost: Cost of one exposure: `WORTH` times the power of `robot` over the picture's [-].
    """

    poses: Array
    robot: NDArray[np.float32]
    scores: Array
    strengths: Array
    explained: float
    cost: float

    def gain(self, other: "Fit") -> float:
        """Compute the gain of `explained` over another fit, less the cost of added exposures [-].

        Each added one costs the mean of both fits' `cost`: a picture of the robot solved at too few
        exposures is fainter, so that each of them would seem to cost less.
        """
        more = len(self.poses) - len(other.poses)
        return self.explained - other.explained - 0.5 * (self.cost + other.cost) * more


class MeanReading(Reading):
    """Reading of a picture that is the mean of several exposures.

    `body` reaches beyond the robot's top, over what its sides and legs cover.
    """

    margin = 0.28

    @cached_property
    def floor(self) -> FloorColours:
        """Colour model of the floor, light varying over the robot's length."""
        return FloorColours.of(
            self.picture, self.used, width=self.length / self.plane.cell, noise=0.5
        )

    @cached_property
    def weighing(self) -> Array:
        """Matrix W (3, 3) that whitens the floor's colours, (n, 3) @ W, to deviation `SCALE`."""
        return SCALE * self.floor.whitening

    @cached_property
    def change(self) -> NDArray[np.float32]:
        """Whitened difference from the floor's light, 0 where unused, (rows, columns, 3)."""
        change = (self.picture - self.floor.light) @ self.weighing
        return (change * self.used[..., None]).astype(np.float32)

    @cached_property
    def detail(self) -> NDArray[np.float32]:
        """High-pass filtered `change`, without variation over more than `DETAIL` of the length.

        Planks, and the light of a lamp on them, are as strong as a robot at 1/n; they vary slowly.
        """
        width = DETAIL * self.length / self.plane.cell
        detail = self.change - smooth(self.change, self.used, width)
        return detail * self.used[..., None]

    @cached_property
    def power(self) -> float:
        """Sum of `detail` squared over all points and colours."""
        return float((self.detail**2).sum())

    def find(self) -> Array:
        """Find the poses (n, 3), known one first, that gain most (`Fit.gain`); drop weak ones."""
        best = self.fitted(self.first_matches(self.known.pose.planar), rounds=2)
        for _ in range(_ROUNDS):
            tried = [self.fitted(poses, rounds=1) for poses in self.varied(best)]
            new = max(tried, key=lambda fit: fit.gain(best), default=best)
            if new.gain(best) <= _BETTER:
                break
            best = self.fitted(new.poses, rounds=1)
        return self.accepted(self.fitted(best.poses, rounds=3))

    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align each exposure with the residual of the picture after the others are subtracted.

        Where exposures overlap (median distance below the robot's length), those of too little
        correlation but the known one are dropped; elsewhere they keep their pose on the raster.
        """
        known = self.known
        fine = fine_whitening(known)
        weighed = (known.pixels @ fine).astype(np.float32)
        residuals = self.residuals(poses, weighed, np.linalg.inv(self.weighing) @ fine)
        if usual_step(poses) < self.length:
            return MeanAlignment(known, residuals, poses).exposures()
        pattern = floor_pattern(known, weighed, poses)
        flat = [pattern.flat(residual) for residual in residuals]
        return MeanAlignment(known, flat, poses, pattern).exposures()

    def residuals(
        self, poses: Array, weighed: NDArray[np.float32], weighed_again: Array
    ) -> list[NDArray[np.float32]]:
        """Return for each exposure the picture `weighed` less all other exposures around it.

        Args:
            poses: x, y and yaw of the exposures, shape (n, 3) [m, m, rad].
            weighed: The picture in whitened colours, shape (height, width, 3).
            weighed_again: Matrix from the raster's whitened colours to those of `weighed`, (3, 3).
        """
        robot = solve_robot(self.body, poses, self.change)
        residuals = []
        for k, pose in enumerate(poses):
            others = superposed(self.body, np.delete(poses, k, axis=0), robot)
            seen = self.known.on_photo(others, self.plane, pose)
            residuals.append((weighed - seen @ weighed_again).astype(np.float32))
        return residuals

    def accepted(self, fit: Fit) -> Array:
        """Return the known pose and those that reach all `LEAST_...` of score and strength."""
        usual = float(np.median(fit.scores[1:])) if len(fit.scores) > 1 else 0.0
        least = max(LEAST_SCORE, LEAST_OF_USUAL * usual)
        good = (fit.scores >= least) & (fit.strengths >= LEAST_STRENGTH)
        good[0] = True
        return fit.poses[good]

    def first_matches(self, anchor: Array) -> Array:
        """Match the robot as seen at the known pose (3,) everywhere; return poses, it first."""
        robot = self.body.read(self.detail, anchor)
        poses = anchor[None]
        matches = [m for m in self.matches(self.detail, robot) if m.score >= BESIDE_SCORE]
        while len(poses) < MOST_EXPOSURES and (new := self.next_of(matches, poses)) is not None:
            poses = np.concatenate((poses, self.refined(self.detail, robot, new)[None]))
        return poses

    def next_of(self, matches: Sequence[Match], poses: Array) -> Array | None:
        """Choose the next exposure: the best match a step away, or the nearest farther one.

        Args:
            matches: Matches, best first.
            poses: Known exposures, shape (n, 3) [m, m, rad].

        Returns:
            Pose, shape (3,), or None. Farther matches count only beside a single known exposure, or
            where the usual step is at least `REACH` lengths of the robot.
        """
        new = self.candidates(matches, poses)
        away = [float(distances(poses, pose).min()) for pose in new]
        if beside := [k for k, distance in enumerate(away) if distance <= REACH * self.length]:
            return new[beside[0]]
        if not new or 0 < usual_step(poses) < REACH * self.length:
            return None
        return new[int(np.argmin(away))]

    def candidates(self, matches: Sequence[Match], poses: Array) -> list[Array]:
        """List the poses of matches that may be further exposures.

        Each is a step from a known exposure with nearly the same heading, or has `LONELY_SCORE` and
        is farther than a step from all. Before, matches of that score that do not follow one are
        turned by half turns (quarters, if square) to the direction from the nearest exposure.

        Args:
            matches: Matches, best first.
            poses: Known exposures, shape (n, 3) [m, m, rad].

        Returns:
            Poses, shape (3,) each [m, m, rad].
        """
        found = []
        for score, pose in matches:
            clear = score >= LONELY_SCORE
            if clear and not self.follows(pose, poses):
                pose = headed(pose, poses, square=self.known.box.is_square)
            far = clear and is_apart(pose, poses, REACH * self.length)
            if far or self.follows(pose, poses):
                found.append(pose)
        return found

    def matches(self, change: NDArray[np.float32], robot: NDArray[np.float32]) -> list[Match]:
        """Match the robot's picture at all headings (normalised cross-correlation).

        Args:
            change: Difference from the floor, or its detail, shape (rows, columns, 3).
            robot: The robot's picture, on the robot's raster.

        Returns:
            Matches of a correlation of at least 0.4, best first.
        """
        template = self.body.template(robot, self.known.plate.height)
        return match_whole(change, self.plane, template=template, least=_LEAST_MATCH)

    def follows(self, pose: Array, poses: Array) -> bool:
        """Return whether a pose is a step from some exposure, with nearly its heading.

        Args:
            pose: x, y [m] and yaw [rad], shape (3,).
            poses: Known exposures, shape (n, 3); False if one is nearer than `LEAST_STEP`.
        """
        far = is_apart(pose, poses, LEAST_STEP * self.length)
        return far and is_beside(pose, list(poses), self.length)

    def varied(self, fit: Fit) -> list[Array]:
        """List sets of poses, the known first: one added, the weakest removed, ends moved one."""
        left = self.detail - superposed(self.body, fit.poses, fit.robot)
        left *= self.used[..., None]
        new = self.candidates(self.matches(left, fit.robot), fit.poses)
        sets = [np.concatenate((fit.poses, pose[None])) for pose in new[:_TRIED]]
        if len(fit.poses) > 1:
            sets += shifted_sets(fit.poses)
            weakest = 1 + int(np.argmin(fit.scores[1:]))
            sets.append(np.delete(fit.poses, weakest, axis=0))
        return [poses for poses in sets if are_apart(poses, self.length)]

    def fitted(self, poses: Array, *, rounds: int) -> Fit:
        """Fit all poses but the first, and the robot's picture, by least squares and local search.

        Args:
            poses: Poses to start from, the known one first, shape (n, 3) [m, m, rad]; not changed.
            rounds: Number of alternations, at least 1.
        """
        poses = poses.copy()
        robot = solve_robot(self.body, poses, self.detail)
        scores, strengths = self.improve(poses, robot)
        for _ in range(rounds - 1):
            robot = solve_robot(self.body, poses, self.detail)
            scores, strengths = self.improve(poses, robot)
        left = (self.detail - superposed(self.body, poses, robot)) * self.used[..., None]
        own = float((robot[self.body.body] ** 2).sum())
        explained = 1 - float((left**2).sum()) / self.power
        return Fit(poses, robot, scores, strengths, explained, WORTH * own / self.power)

    def improve(self, poses: Array, robot: NDArray[np.float32]) -> tuple[Array, Array]:
        """Refine all poses but the first, in place, each on the residual of the others.

        Args:
            poses: Exposures, shape (n, 3) [m, m, rad]; changed.
            robot: The robot's picture, on the robot's raster.

        Returns:
            Correlations and relative strengths, shape (n,) each [-]; 1 for the first.
        """
        left = self.detail - superposed(self.body, poses, robot)
        scores, strengths = np.ones(len(poses)), np.ones(len(poses))
        for k in range(1, len(poses)):
            window, laid = self.body.laid(robot, poses[k])
            left[window] += laid
            alone = left * self.used[..., None]
            poses[k] = self.refined(alone, robot, poses[k])
            scores[k], strengths[k] = self.correlation(alone, robot, poses[k])
            window, laid = self.body.laid(robot, poses[k])
            left[window] -= laid
        return scores, strengths

    def refined(
        self, change: NDArray[np.float32], robot: NDArray[np.float32], pose: Array
    ) -> Array:
        """Return the pose refined by maximising the correlation with the robot's picture.

        Args:
            change: Picture to compare with, shape (rows, columns, 3).
            robot: The robot's picture, on the robot's raster.
            pose: Pose to start from, shape (3,) [m, m, rad].
        """
        return improved(
            lambda place: self.correlation(change, robot, place)[0], pose, reach=CLIMB, tries=120
        )[0]

    def correlation(
        self, change: NDArray[np.float32], robot: NDArray[np.float32], pose: Array
    ) -> tuple[float, float]:
        """Compute correlation and regression coefficient of a picture on the robot's picture.

        Args:
            change: Picture to compare with, shape (rows, columns, 3).
            robot: The robot's picture, on the robot's raster.
            pose: x, y [m] and yaw [rad] at which to compare, shape (3,).

        Returns:
            Correlation and regression coefficient ("strength") of the colours on the body [-].
        """
        seen = self.body.read(change, pose)[self.body.body]
        own = robot[self.body.body]
        seen, own = seen - seen.mean(axis=(0, 1)), own - own.mean(axis=(0, 1))
        cross, power = float((seen * own).sum()), float((own * own).sum())
        spread = float((seen * seen).sum())
        return cross / np.sqrt(max(power * spread, 1e-9)), cross / max(power, 1e-9)
