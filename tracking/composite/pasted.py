# SPDX-License-Identifier: MIT
"""Find and align exposures of robots that were cut out and pasted on each other.

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
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.search import match_whole
from tracking.body.template import sample
from tracking.composite.colours import NOISE, FloorColours, colour_density, robot_density
from tracking.composite.known import LEAST_SCORE, Exposure, disturbance_sd, strip_sd, widened
from tracking.composite.reading import BodyRaster, Reading
from tracking.composite.steps import (
    CLIMB,
    LEAST_STEP,
    REACH,
    apart,
    beside,
    distances,
    headed,
    improved,
    is_apart,
    usual_step,
)
from tracking.pose import BodyPose

LEAST_GAIN = 0.05
"""Least log odds of an exposure, sum over its visible points over the number of all points of its
top [-]."""

LEAST_ODDS = 0.9
"""Least log odds of an exposure, mean over the visible points of its top [-]."""

MOST_EXPOSURES = 40  # where the search for more ends

MARGIN, FLOOR_MARGIN = 0.05, 0.25
"""Margins of a cut-out around the robot, in lengths of the robot: what is hidden in any case, and
where points of the floor's colour may be hidden [-]."""

OUTLIER_SD = 2.5
"""Standard deviations beyond which a point of a pasted exposure is an outlier [-]."""

_LEAST_OF_STEP = 0.6  # least distance as a share of the usual step; intervals are regular
_LEAST_MATCH = 0.5  # least correlation of a place with the whole known exposure
_SHOWS = 0.5  # share of visible points that are not occluded
_TRIED = 5  # largest number of poses from which a search starts
_FAR = 3.0  # in standard deviations: beyond it the colour differs from that a step away
_STRIP_LEVER = 0.9  # lever arm for the heading of a strip, of the length
_TOGETHER = 100  # poses whose colours fit into a processor's cache


class Pasted(NamedTuple):
    """An exposure in a pasted picture.

    Attributes:
        pose: x, y [m] and yaw [rad], shape (3,).
        gain: Log odds, mean over all points of the robot's top, 0 where hidden [-].
        look: Colours of the robot's top, on the robot's raster, shape (rows, columns, 3): what is
            visible in this exposure, elsewhere as in those found before.
    """

    pose: Array
    gain: float
    look: NDArray[np.float32]


@dataclass(frozen=True)
class PastedReading(Reading):
    """Reading of a picture of exposures that were cut out and pasted on each other.

    Attributes:
        with_floor: Whether floor and shadow around the robot were cut out with it.
    """

    with_floor: bool = False

    @cached_property
    def layers(self) -> NDArray[np.float32]:
        """Colour of each point [grey levels], and its density among all points used, (m, n, 4)."""
        density = colour_density(self.picture[self.used], self.picture, blur=1.0)
        return np.dstack((self.picture, density.astype(np.float32)))

    @cached_property
    def floor(self) -> NDArray[np.bool_]:
        """Mask of the plane's points whose colour is the floor's, lit or in shadow."""
        width = self.length / self.plane.cell
        return FloorColours.of(self.picture, self.used, width=width, noise=3.0).shows(self.picture)

    @cached_property
    def likelier(self) -> tuple["PastedReading", list[Pasted]]:
        """The reading with the greater sum of gains, without or with floor, and its exposures."""
        ways = [(way, way.search(self.matches)) for way in (self, replace(self, with_floor=True))]
        return max(ways, key=lambda way: sum(each.gain for each in way[1]))

    @cached_property
    def matches(self) -> list[Array]:
        """Poses (3,) at which the whole known exposure correlates by 0.5 or more, best first."""
        robot = self.body.read(self.picture, self.known.pose.planar)
        template = self.body.template(robot, self.known.plate.height)
        return match_whole(self.picture, self.plane, template=template, least=_LEAST_MATCH)

    def find(self) -> Array:
        """Find all exposures in the likelier of the readings without and with floor.

        Returns:
            x, y [m] and yaw [rad], the known exposure first and then each after those on top of
            it, shape (n, 3).
        """
        return np.array([each.pose for each in self.likelier[1]])

    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align the visible part of each exposure, in order; keep the raster's pose on failure.

        The poses are those of `find`: each exposure hides pixels of those after it. Covariances are
        widened by `disturbance_sd` and `strip_sd`.
        """
        known, found = self.known, []
        template, visible = known.body_template(), ~known.hidden
        for pose in poses:
            share = known.share(pose, visible)
            alignment = known.aligned(
                pose, template, visible, least=LEAST_SCORE, outlier_sd=OUTLIER_SD
            )
            if alignment is None:
                alignment = known.rough(pose)
            else:
                disturbed = disturbance_sd(alignment.score, share)
                placed = float(np.hypot(disturbed, strip_sd(share)))
                alignment = widened(alignment, placed * self.length, disturbed / _STRIP_LEVER)
            found.append(Exposure(alignment, share))
            visible = visible & ~self.likelier[0].hidden_pixels(alignment.pose)
        return tuple(found)

    def hidden_pixels(self, pose: BodyPose) -> NDArray[np.bool_]:
        """Compute the mask (height, width) of pixels of lower exposures that one hides or may hide.

        If `with_floor`, it may hide pixels of the floor's colour up to `FLOOR_MARGIN` around it.

        Args:
            pose: Pose of the exposure on top, whose cut-out with its margin hides them.
        """
        hidden = self.known.box.hidden(pose.state, margin=MARGIN)
        if self.with_floor:
            floor = self.known.on_photo(self.floor, self.plane, pose.planar, reach=1.25) > 0.5
            hidden |= floor & self.known.box.hidden(pose.state, margin=FLOOR_MARGIN)
        return hidden

    def hidden_points(self, pose: Array) -> NDArray[np.bool_]:
        """Compute the mask of the plane's points of lower exposures that one hides or may hide.

        If `with_floor`, it may hide points of the floor's colour up to `FLOOR_MARGIN` around it.

        Args:
            pose: x, y [m] and yaw [rad] of the exposure on top, shape (3,).
        """
        hidden = self.known.box.hidden_on(self.plane, pose, margin=MARGIN)
        if self.with_floor:
            hidden |= self.known.box.hidden_on(self.plane, pose, margin=FLOOR_MARGIN) & self.floor
        return hidden

    def shown(self, found: Sequence[Pasted]) -> NDArray[np.float32]:
        """Return 1 at points used that none of `found` hides, else 0, shape (rows, columns)."""
        visible = self.used.copy()
        for each in found:
            visible &= ~self.hidden_points(each.pose)
        return visible.astype(np.float32)

    def search(self, matches: Sequence[Array]) -> list[Pasted]:
        """Find all exposures for `with_floor` as it is, the known one first.

        Args:
            matches: Where to look beyond the neighbours of those found (see `matches`).
        """
        pose = self.known.pose.planar
        robot = self.body.read(self.picture, pose)
        gains, _ = self.gains(pose[None], robot, self.shown([]), self.body)
        found = self.stack_under(Pasted(pose, float(gains[0]), robot), [])
        beyond = list(matches)
        while beyond:
            poses = np.array([each.pose for each in found])
            beyond.sort(key=lambda pose: -distances(poses, pose).min())
            start = headed(beyond.pop(), poses, square=self.known.box.is_square)
            away = distances(poses, start)
            if away.min() > REACH * self.length:
                look = found[int(np.argmin(away))].look
                new = self.climbed([start], found, look)
                found = found if new is None else self.stack_under(new, found)
        return self.in_step(found)

    def stack_under(self, top: Pasted, found: Sequence[Pasted]) -> list[Pasted]:
        """Add an exposure that no other hides and the chains of exposures below it, both ways.

        Args:
            top: The exposure that no other hides.
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
        """List the exposure that another partly hides, the one this hides, and so on; may be empty.

        Args:
            above: Exposure to start from.
            found: Known exposures.
            opposite: Pose, shape (3,) [m, m, rad]. If given, the first exposure found lies on the
                other side of `above`.
        """
        chain: list[Pasted] = []
        while len(found) + len(chain) < MOST_EXPOSURES:
            places = beside(above.pose, self.length, spacing=self.length / 20)
            if opposite is not None and not chain:
                ahead = (places[:, :2] - above.pose[:2]) @ (opposite[:2] - above.pose[:2])
                places = places[ahead < 0]
            new = self.under(above, [*found, *chain], places)
            if new is None:
                break
            chain.append(new)
            above = new
        return chain

    def in_step(self, found: Sequence[Pasted]) -> list[Pasted]:
        """Drop exposures nearer to another than 0.6 of the usual step, those of least gain first.

        The first stays. Of three or fewer none is dropped: the middle one of three is half as far
        from the others.
        """
        kept = list(found)
        for each in sorted(found[1:], key=lambda each: each.gain):
            poses = np.array([other.pose for other in kept])
            away = distances(poses, each.pose)
            if len(kept) > 3 and np.sort(away)[1] <= _LEAST_OF_STEP * usual_step(poses):
                kept = [other for other in kept if other is not each]
        return kept

    def under(self, above: Pasted, found: Sequence[Pasted], places: Array) -> Pasted | None:
        """Find the likeliest exposure below all known ones, beside one of them.

        Args:
            above: The exposure beside which to search, whose colours are expected.
            found: Known exposures.
            places: Candidate poses, shape (n, 3) [m, m, rad]; none nearer to a known exposure than
                `LEAST_STEP` is tried.

        Returns:
            The exposure, or None where none is likely enough.
        """
        look = above.look[1::2, 1::2]
        gains, _ = self.gains(places, look, self.shown(found), self.body.thinned())
        away = np.min([distances(places, each.pose) for each in found], axis=0)
        gains = np.where(away > LEAST_STEP * self.length, gains, -np.inf)
        starts = apart(places, gains, LEAST_STEP / 2 * self.length, most=_TRIED)
        return self.climbed(starts, found, above.look)

    def climbed(
        self, starts: Sequence[Array], found: Sequence[Pasted], look: NDArray[np.float32]
    ) -> Pasted | None:
        """Refine candidate poses by maximising their log odds; return the likeliest exposure.

        Args:
            starts: Candidate poses, shape (3,) each [m, m, rad].
            found: Known exposures.
            look: Colours expected of the robot's top, on the robot's raster.

        Returns:
            The exposure of greatest gain that reaches `LEAST_GAIN` and `LEAST_ODDS` and is farther
            than `LEAST_STEP` from all known ones, with its own `look` (`seen_again`); or None.
        """
        shown, known, best = self.shown(found), [each.pose for each in found], None
        for start in starts:
            pose, gain = improved(
                lambda pose: float(self.gains(pose[None], look, shown, self.body)[0][0]),
                start, reach=CLIMB, tries=90,
            )  # fmt: skip
            share = self.gains(pose[None], look, shown, self.body)[1][0]
            likely = gain >= max(LEAST_GAIN, LEAST_ODDS * share, best.gain if best else 0.0)
            if likely and is_apart(pose, known, LEAST_STEP * self.length):
                best = Pasted(pose, gain, look)
        return best and best._replace(look=self.seen_again(best.pose, look, shown))

    def seen_again(
        self, pose: Array, look: NDArray[np.float32], shown: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """Update the colours of the robot's top at the points where an exposure is visible.

        Args:
            pose: x, y [m] and yaw [rad] of the exposure, shape (3,).
            look: Colours expected, on the robot's raster.
            shown: 1 where no other exposure hides the picture, shape (rows, columns).

        Returns:
            The picture's colours where visible and within 3 standard deviations of those expected,
            else those expected, on the robot's raster.
        """
        place = self.body.on(pose[None])[0]
        seen, visible = sample(self.picture, place), sample(shown, place) > 0.9
        same = visible & (((seen - look) ** 2).sum(axis=-1) < _FAR**2 * NOISE**2)
        return np.where(same[..., None], seen, look)

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
            Log odds, mean over all points of the top with 0 at hidden ones, and share of points
            that are visible; shape (n,) each [-].
        """
        parts = []
        for some in np.array_split(poses, 1 + len(poses) // _TOGETHER):
            place = body.on(some)
            seen, visible = sample(self.layers, place), sample(shown, place) > 0.9
            same = robot_density(seen[..., :3] - robot) / np.maximum(seen[..., 3], 1e-12)
            # An occluded point is given 0.4 of the picture's density: it costs at most log 0.2.
            log_odds = np.log(_SHOWS * same + 0.4 * (1 - _SHOWS))
            gain = np.where(visible, log_odds, 0.0).mean(axis=(1, 2))
            parts.append((gain, visible.mean(axis=(1, 2))))
        gains, shares = (np.concatenate(each) for each in zip(*parts, strict=True))
        return gains, shares
