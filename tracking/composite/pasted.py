# SPDX-License-Identifier: MIT
"""Find exposures in a picture of robots that were cut out and pasted on each other.

Each exposure is visible where no other hides it, perhaps only as a strip of its top with a leg of
the next across. A pose is scored by log odds: the log likelihood ratio of the robot's colours
against the picture's own colours, over the points that would be visible. Colours of a robot are
rare in the picture. No share of agreement is required: a narrow strip that agrees scores more than
a wide one that half agrees, and an occluded point costs only a bounded amount. Light varies over a
floor, so an exposure is compared with the colours of the one a step away.

A cut-out may have a margin, or may contain floor and shadow around the robot. Then points near an
exposure that look like floor carry no information: they may lie on another exposure.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tracking.body.template import sample
from tracking.camera.lens import Array
from tracking.composite.body_box import BodyBox
from tracking.composite.body_raster import BodyRaster
from tracking.composite.candidates import CLIMB, LEAST_STEP, REACH, apart, beside, headed
from tracking.composite.chain import distances, improved, usual_step
from tracking.composite.colours import NOISE, ColourDensity, FloorColours, robot_density
from tracking.composite.match import Match, match_whole
from tracking.composite.reading import PictureRaster

LEAST_GAIN = 0.05
"""Least log odds of an exposure, mean over all points of its top, hidden or not [-]."""

LEAST_ODDS = 0.9
"""Least log odds of an exposure, mean over what is visible of it [-]."""

MOST_EXPOSURES = 40

LEFT, FLOOR_LEFT = 0.05, 0.25
"""Margins of a cut-out around the robot: opaque, and of floor, as shares of its length [-]."""

_LEAST_OF_STEP = 0.6  # least distance as a share of the usual step; intervals are regular
_LEAST_MATCH = 0.5
_SHOWS = 0.5  # share of visible points that are not occluded
_TRIED = 5
_FAR = 3.0  # in standard deviations: beyond it the colour differs from that a step away


class Pasted(NamedTuple):
    """An exposure: pose, log odds (mean over all points of its top) and colours of its top."""

    pose: Array
    gain: float
    look: NDArray[np.float32]


@dataclass(frozen=True)
class PastedSearch(PictureRaster):
    """Search for exposures in a picture of pasted exposures, on a raster.

    Attributes:
        box: The robot's body.
        with_floor: Whether floor and shadow were cut out with the robot.
    """

    box: BodyBox
    with_floor: bool

    @property
    def length(self) -> float:
        """The robot's length [m]."""
        return self.box.size[0]

    @cached_property
    def usual(self) -> NDArray[np.float32]:
        """Density, in the whole picture, of the colour of every point."""
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
        found = self.stack_under(Pasted(known, self.whole(known, robot), robot), [])
        beyond = [match.planar for match in self.matches(robot)]
        while beyond:
            poses = np.array([each.pose for each in found])
            beyond.sort(key=lambda pose: -distances(poses, pose).min())
            start = headed(beyond.pop(), poses, square=self.box.is_square)
            away = distances(poses, start)
            if away.min() > REACH * self.length:
                look = found[int(np.argmin(away))].look
                new = self.climbed([start], found, look, self.visible(found))
                if new is not None:
                    found = self.stack_under(new, found)
        kept = self.in_step(found)
        return np.array([each.pose for each in kept]), sum(each.gain for each in kept)

    def whole(self, pose: Array, robot: NDArray[np.float32]) -> float:
        """Compute the log odds of an exposure that no other hides.

        Args:
            pose: x, y [m] and yaw [rad], shape (3,).
            robot: Colours of the robot's top, on the robot's raster.
        """
        shown = self.used.astype(np.float32)
        return float(self.gains(pose[None], robot, shown, self.body)[0][0])

    def matches(self, robot: NDArray[np.float32]) -> list[Match]:
        """Match the robot's template at all headings; best first."""
        template = self.body.template(robot, self.box.top)
        return match_whole(self.picture, self.plane, template=template, least=_LEAST_MATCH)

    def stack_under(self, top: Pasted, found: Sequence[Pasted]) -> list[Pasted]:
        """Add an exposure that shows whole and the chains of exposures below it, on both sides.

        Args:
            top: The exposure that shows whole.
            found: Known exposures.

        Returns:
            Known and new exposures; those on top before those below.
        """
        found = [*found, top]
        one_side = self.chain_under(top, found)
        if not one_side:
            return found
        found += one_side
        return found + self.chain_under(top, found, opposite=one_side[0].pose)

    def chain_under(
        self, above: Pasted, found: Sequence[Pasted], *, opposite: Array | None = None
    ) -> list[Pasted]:
        """Find the exposure that another partly hides, then the one that this hides, and so on.

        Args:
            above: Exposure to start from.
            found: Known exposures.
            opposite: Pose, shape (3,) [m, m, rad]. If given, the first exposure found lies on the
                other side of `above`.
        """
        chain: list[Pasted] = []
        places = beside(above.pose, self.length, spacing=self.length / 20)
        if opposite is not None:
            ahead = (places[:, :2] - above.pose[:2]) @ (opposite[:2] - above.pose[:2])
            places = places[ahead < 0]
        while len(found) + len(chain) < MOST_EXPOSURES:
            new = self.under(above, [*found, *chain], places)
            if new is None:
                break
            chain.append(new)
            above, places = new, beside(new.pose, self.length, spacing=self.length / 20)
        return chain

    def visible(self, found: Sequence[Pasted]) -> NDArray[np.bool_]:
        """Compute the mask of points of the raster that no exposure hides."""
        visible = self.used.copy()
        for each in found:
            visible &= ~self.hidden_by(each.pose)
        return visible

    def in_step(self, found: Sequence[Pasted]) -> list[Pasted]:
        """Drop exposures that are much nearer to a likelier one than the usual step.

        The first stays. Of three none is dropped: the middle one is half as far from the others.
        """
        kept = list(found)
        for each in sorted(found[1:], key=lambda each: each.gain):
            poses = np.array([other.pose for other in kept])
            away = distances(poses, each.pose)
            if len(kept) > 3 and np.sort(away)[1] <= _LEAST_OF_STEP * usual_step(poses):
                kept = [other for other in kept if other is not each]
        return kept

    @cached_property
    def floor(self) -> NDArray[np.bool_]:
        """Mask of points whose colour is the floor's, lit or in shadow."""
        width = self.length / self.plane.cell
        return FloorColours.of(self.picture, self.used, width=width, noise=3.0).shows(self.picture)

    def hidden_by(self, pose: Array) -> NDArray[np.bool_]:
        """Compute the mask of points of the raster that an exposure hides, or may hide."""
        hidden = self.box.hidden_on(self.plane, pose, left=LEFT)
        if self.with_floor:
            hidden |= self.box.hidden_on(self.plane, pose, left=FLOOR_LEFT) & self.floor
        return hidden

    def under(self, above: Pasted, found: Sequence[Pasted], places: Array) -> Pasted | None:
        """Find the likeliest exposure below all known ones, beside one of them.

        Args:
            above: The exposure beside which to search.
            found: Known exposures.
            places: Candidate poses, shape (n, 3) [m, m, rad].
        """
        visible = self.visible(found)
        shown = visible.astype(np.float32)
        gains, _ = self.gains(places, above.look[1::2, 1::2], shown, self.body.thinned())
        gains = np.where(self.are_new(places, found), gains, -np.inf)
        starts = apart(places, gains, LEAST_STEP / 2 * self.length, most=_TRIED)
        return self.climbed(starts, found, above.look, visible)

    def climbed(
        self, starts: Sequence[Array], found: Sequence[Pasted], look: NDArray[np.float32],
        visible: NDArray[np.bool_],
    ) -> Pasted | None:  # fmt: skip
        """Improve candidate poses by local search.

        Args:
            starts: Candidate poses, shape (3,) each [m, m, rad].
            found: Known exposures.
            look: Colours expected of the robot's top, on the robot's raster.
            visible: Mask of points that no known exposure hides, shape (rows, columns).

        Returns:
            The likeliest that is accepted (`holds`), or None.
        """
        shown = visible.astype(np.float32)

        def gain(pose: Array) -> float:
            """Log odds of one place."""
            return float(self.gains(pose[None], look, shown, self.body)[0][0])

        places = [improved(gain, start, reach=CLIMB, tries=90)[0] for start in starts]
        good = [pose for pose in places if self.holds(pose, found, look, shown)]
        if not good:
            return None
        best = max(good, key=gain)
        return Pasted(best, gain(best), self.seen_again(best, look, shown))

    def seen_again(
        self, pose: Array, look: NDArray[np.float32], shown: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """Update the colours of the robot's top at the points where an exposure is visible.

        Args:
            pose: x, y [m] and yaw [rad] of the exposure, shape (3,).
            look: Colours expected, on the robot's raster.
            shown: 1 where no other exposure hides the picture, shape (rows, columns).

        Returns:
            Colours seen where they agree with those expected, else those expected.
        """
        place = self.body.on(self.plane, pose[None])[0]
        seen, visible = sample(self.picture, place), sample(shown, place) > 0.9
        same = visible & (((seen - look) ** 2).sum(axis=-1) < _FAR**2 * NOISE**2)
        return np.where(same[..., None], seen, look)

    def holds(
        self, pose: Array, found: Sequence[Pasted], look: NDArray[np.float32],
        shown: NDArray[np.float32],
    ) -> bool:  # fmt: skip
        """Return whether a pose is likely enough and apart from all known exposures.

        Args:
            pose: x, y [m] and yaw [rad], shape (3,).
            found: Known exposures.
            look: Colours expected, on the robot's raster.
            shown: 1 where no known exposure hides the picture, shape (rows, columns).
        """
        (gain,), (share,) = self.gains(pose[None], look, shown, self.body)
        likely = gain >= LEAST_GAIN and gain >= LEAST_ODDS * share
        return bool(likely and self.are_new(pose[None], found).all())

    def are_new(self, tried: Array, found: Sequence[Pasted]) -> NDArray[np.bool_]:
        """Return which poses are apart from all known exposures.

        Args:
            tried: Candidate poses, shape (n, 3) [m, m, rad].
            found: Known exposures.

        Returns:
            Mask, shape (n,).
        """
        away = np.min([distances(tried, each.pose) for each in found], axis=0)
        return away > LEAST_STEP * self.length

    def gains(
        self, poses: Array, robot: NDArray[np.float32], shown: NDArray[np.float32], body: BodyRaster
    ) -> tuple[Array, Array]:
        """Compute the log odds of the robot against the picture's own colours, at many poses.

        Args:
            poses: Candidate poses, shape (n, 3) [m, m, rad].
            robot: Colours of the robot's top, on the points of `body`.
            shown: 1 where no known exposure hides the picture, shape (rows, columns).
            body: Points of the robot's top to compare.

        Returns:
            Log odds, mean over all points of its top, and the share of these that is visible; each
            of shape (n,) [-].
        """
        place = body.on(self.plane, poses)
        seen, usual = sample(self.picture, place), sample(self.usual, place)
        visible = sample(shown, place) > 0.9
        same = robot_density(seen - robot) / np.maximum(usual, 1e-12)
        log_odds = np.log(_SHOWS * same + 0.4 * (1 - _SHOWS))
        gain = np.where(visible, log_odds, 0.0).mean(axis=(1, 2))
        return gain, visible.mean(axis=(1, 2))
