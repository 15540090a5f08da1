# SPDX-License-Identifier: MIT
"""Read a picture of exposures that were cut out and pasted on each other.

Each is there as far as no other hides it, and may be no more than a strip of its top with a leg of
the next across. A place is judged by its log odds: how much likelier the robot makes the colours
of what would be visible of it than the picture's own colours do, of which a robot's are rare. That
asks for no share of agreement: a narrow strip that agrees is worth more than a wide one that half
agrees, and a point that something lies on costs no more than it tells.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tracking.body.template import sample
from tracking.camera.lens import Array
from tracking.composite.body_box import BodyBox
from tracking.composite.body_raster import BodyRaster
from tracking.composite.candidates import CLIMB, LEAST_STEP, REACH, apart, beside, headed
from tracking.composite.chain import distances, improved, usual_step
from tracking.composite.colours import ColourDensity, robot_density
from tracking.composite.match import Match, match_whole
from tracking.composite.reading import Reading

LEAST_GAIN = 0.05
"""Least log odds of an exposure, mean over all points of its top, hidden or not [-]."""

LEAST_ODDS = 0.9
"""Least log odds of an exposure, mean over what is visible of it [-]."""

MOST_EXPOSURES = 40

_LEAST_OF_STEP = 0.6  # intervals are regular: an exposure is not much nearer to another than usual
_LEAST_MATCH = 0.5
_SHOWS = 0.5  # share of visible points on which nothing lies
_TRIED = 5


@dataclass(frozen=True)
class PastedReading(Reading):
    """A picture of pasted exposures, on a raster.

    Attributes:
        box: The robot's body.
        left: What scissors left around the robot and hides others, as a share of its length [-].
    """

    box: BodyBox
    left: float

    @property
    def length(self) -> float:
        """The robot's length [m]."""
        return self.box.size[0]

    @cached_property
    def usual(self) -> NDArray[np.float32]:
        """How dense the colour of every point is in the whole picture."""
        density = ColourDensity.of(self.picture[self.used], blur=1.0)
        return density(self.picture).astype(np.float32)

    def find(self, known: Array) -> tuple[Array, float]:
        """Find all exposures.

        Args:
            known: x, y [m] and yaw [rad] of an exposure that shows whole how the robot looks.

        Returns:
            Poses, that one first and those on top before those under them, shape (n, 3); and by
            how much they make the picture likelier, in points of an exposure.
        """
        robot = self.body.read(self.picture, self.plane, known)
        poses, odds = self.stack_under(known, [], [], robot, self.whole(known, robot))
        beyond = [match.planar for match in self.matches(robot)]
        while beyond:
            beyond.sort(key=lambda pose: -distances(np.array(poses), pose).min())
            start = headed(beyond.pop(), np.array(poses), square=self.box.is_square)
            if distances(np.array(poses), start).min() > REACH * self.length:
                new = self.climbed([start], poses, robot, self.visible(poses))
                if new is not None:
                    poses, odds = self.stack_under(new[0], poses, odds, robot, new[1])
        steps = self.are_steps(np.array(poses), np.array(odds))
        return np.array(poses)[steps], float(np.array(odds)[steps].sum())

    def whole(self, pose: Array, robot: NDArray[np.float32]) -> float:
        """Compute the gain of an exposure that no other hides."""
        shown = self.used.astype(np.float32)
        return float(self.gains(pose[None], robot, shown, self.body)[0][0])

    def matches(self, robot: NDArray[np.float32]) -> list[Match]:
        """Turn the robot's picture and compare; best first."""
        template = self.body.template(robot, self.box.top)
        return match_whole(self.picture, self.plane, template=template, least=_LEAST_MATCH)

    def stack_under(
        self, top: Array, poses: Sequence[Array], odds: Sequence[float],
        robot: NDArray[np.float32], gain: float,
    ) -> tuple[list[Array], list[float]]:  # fmt: skip
        """Add an exposure that shows whole, those that it hides, what they hide, and so on."""
        poses, odds, visible = [*poses, top], [*odds, gain], self.visible(poses)
        visible &= ~self.hidden_by(top)
        first = len(poses) - 1
        for count in range(first, MOST_EXPOSURES):
            while (new := self.under(poses[count], poses, robot, visible)) is not None:
                poses.append(new[0])
                odds.append(new[1])
                visible &= ~self.hidden_by(new[0])
                if count > first:
                    break  # it hides one at most; the others may lie on both sides
            if count + 1 == len(poses):
                break
        return poses, odds

    def visible(self, poses: Sequence[Array]) -> NDArray[np.bool_]:
        """Mark the points of the raster that no exposure hides."""
        visible = self.used.copy()
        for pose in poses:
            visible &= ~self.hidden_by(pose)
        return visible

    def are_steps(self, poses: Array, odds: Array) -> NDArray[np.bool_]:
        """Tell which exposures are not much nearer to a likelier one than steps usually are."""
        good = np.ones(len(poses), dtype=bool)
        for k in np.argsort(odds):
            others = good.copy()
            others[k] = False
            if others.sum() > 1:
                usual = usual_step(poses[others])
                good[k] = distances(poses[others], poses[k]).min() > _LEAST_OF_STEP * usual
        return good

    def hidden_by(self, pose: Array) -> NDArray[np.bool_]:
        """Mark the points of the raster that an exposure hides."""
        return self.box.hidden_on(self.plane, pose, left=self.left)

    def under(
        self, seed: Array, poses: Sequence[Array], robot: NDArray[np.float32],
        visible: NDArray[np.bool_],
    ) -> tuple[Array, float] | None:  # fmt: skip
        """Find the likeliest exposure beside another, under all that are known; and its odds."""
        tried = beside(seed, self.length, spacing=self.length / 20)
        shown = visible.astype(np.float32)
        gains, _ = self.gains(tried, robot[1::2, 1::2], shown, self.body.thinned())
        gains = np.where(self.are_new(tried, poses), gains, -np.inf)
        starts = apart(tried, gains, LEAST_STEP / 2 * self.length, most=_TRIED)
        return self.climbed(starts, poses, robot, visible)

    def climbed(
        self, starts: Sequence[Array], poses: Sequence[Array], robot: NDArray[np.float32],
        visible: NDArray[np.bool_],
    ) -> tuple[Array, float] | None:  # fmt: skip
        """Improve places; return the best that holds, and its gain."""
        shown = visible.astype(np.float32)

        def gain(pose: Array) -> float:
            return float(self.gains(pose[None], robot, shown, self.body)[0][0])

        found = [improved(gain, start, reach=CLIMB, tries=90) for start in starts]
        good = [each for each in found if self.holds(each[0], poses, robot, shown)]
        return max(good, key=lambda each: each[1], default=None)

    def holds(
        self, pose: Array, poses: Sequence[Array], robot: NDArray[np.float32],
        shown: NDArray[np.float32],
    ) -> bool:  # fmt: skip
        """Tell whether a place is likely enough to be an exposure, and none that is known."""
        (gain,), (share,) = self.gains(pose[None], robot, shown, self.body)
        likely = gain >= LEAST_GAIN and gain >= LEAST_ODDS * share
        return bool(likely and self.are_new(pose[None], poses).all())

    def are_new(self, tried: Array, poses: Sequence[Array]) -> NDArray[np.bool_]:
        """Tell which places are not those of known exposures."""
        away = np.min([distances(tried, pose) for pose in poses], axis=0)
        return away > LEAST_STEP * self.length

    def gains(
        self, poses: Array, robot: NDArray[np.float32], shown: NDArray[np.float32], body: BodyRaster
    ) -> tuple[Array, Array]:
        """Compare the robot with the picture's own colours, for places (n, 3).

        Returns:
            Log odds, mean over all points of its top, and the share of these that is visible.
        """
        place = body.on(self.plane, poses)
        seen, usual = sample(self.picture, place), sample(self.usual, place)
        visible = sample(shown, place) > 0.9
        same = robot_density(seen - robot) / np.maximum(usual, 1e-12)
        log_odds = np.log(_SHOWS * same + 0.4 * (1 - _SHOWS))
        gain = np.where(visible, log_odds, 0.0).mean(axis=(1, 2))
        return gain, visible.mean(axis=(1, 2))
