# SPDX-License-Identifier: MIT
"""Find exposures in a picture that holds, of each pixel, the darkest value of all exposures.

Where exposures overlap, each shows only where it is the darkest, and the picture is nowhere
brighter than any of them. This bounds where exposures can be. A set of exposures is scored by
the log likelihood ratio of the picture against the bare floor, summed over the points of its
raster. A point that some exposure covers has the darkest of their colours; or a darker one, from
the colours near the robot, where a leg, a side or a shadow hides it; hardly ever a brighter one.

The robot's colours come from one known exposure, which others partly cover; a covered point takes
the brightest colour that other exposures show of it. While some exposures are still missing,
their repeated pattern is mistaken for the robot's own. Therefore exposures are not added one by
one: whole chains of a steady step from the known exposure on are compared.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tracking.body.template import sample
from tracking.camera.lens import Array
from tracking.composite.body_raster import BodyRaster
from tracking.composite.candidates import (
    CLIMB,
    LEAST_STEP,
    MOST_EXPOSURES,
    apart,
    are_apart,
    beside,
    is_near,
    nearby,
)
from tracking.composite.chain import (
    continued,
    distances,
    improved,
    steady_chain,
    step_between,
    unsteadiness,
    usual_step,
)
from tracking.composite.colours import NOISE, ColourDensity, FloorColours, robot_density
from tracking.composite.order import order_exposures
from tracking.composite.reading import PictureRaster

LEAST_ODDS = 0.25
"""Least log odds of an exposure, mean over the points that it claims [-]."""

LEAST_GAIN = 0.15
"""Least gain of log odds for a further exposure in a chain, mean over its points [-]."""

UNSTEADY = 0.03
"""Penalty for one unit of `unsteadiness` of a chain's steps [-]."""

LEAST_CLAIM = 0.12
"""Least share of its points that an exposure claims, by being the darkest there [-]."""

_SEEN = 0.6  # share of the robot's own points that show it and not a darker thing
_OWN_LOOK = 0.6  # weight of the known exposure's colours against the brightest seen
_BRIGHTER = 0.01  # how often a point is brighter than it could be
_FLOOR_SHARE = 0.85
_ODD, _LIKE_FLOOR = 20.0, 12.0  # squared distances from the floor's colours
_OPEN = 1000.0  # stands for no exposure: brighter than any colour
_LEAST_SEEN = 0.6  # share of an exposure that must be in the picture
_FAR = 2.5  # in standard deviations: beyond it the colour differs
_CLAIM = 6.0  # a point darker than others by this is claimed [grey levels]
_FIRST_STEPS = 10
_POLISH = (0.006, 0.006, 0.05)


class TopColours(NamedTuple):
    """Colours of the robot's top: by the known exposure, and the brightest of all exposures."""

    own: NDArray[np.float32]
    brightest: NDArray[np.float32]

    def thinned(self) -> "TopColours":
        """Return every second point in both directions, as `BodyRaster.thinned` does."""
        return TopColours(self.own[1::2, 1::2], self.brightest[1::2, 1::2])


class Cover(NamedTuple):
    """Darkest colour of several exposures at every point, by both `TopColours`, and log density."""

    own: NDArray[np.float32]
    brightest: NDArray[np.float32]
    log_density: NDArray[np.float32]


@dataclass(frozen=True)
class Chain:
    """Exposures at equal steps from the known one.

    Attributes:
        step: Forward, left, turn and by how much more it turns each time, shape (4,) [m, rad].
        ahead: How many along it.
        behind: How many against it.
    """

    step: Array
    ahead: int
    behind: int

    def poses(self, anchor: Array) -> Array:
        """Compute the poses of the exposures, the known one first, shape (n, 3)."""
        return steady_chain(anchor, self.step[:3], float(self.step[3]), self.ahead, self.behind)

    @classmethod
    def through(cls, poses: Sequence[Array]) -> "Chain":
        """Make a chain of the median step between poses, all ahead of the first."""
        steps = [step_between(a, b) for a, b in pairwise(poses)]
        return cls(np.append(np.median(steps, axis=0), 0.0), len(steps), 0)

    @property
    def with_some_between(self) -> "Chain":
        """The chain with half the step and twice the exposures, in case every second was missed."""
        return Chain(self.step * [0.5, 0.5, 0.5, 0.25], 2 * self.ahead, 2 * self.behind)

    @property
    def longer(self) -> tuple["Chain", "Chain"]:
        """The chain with one more exposure ahead, and with one more behind."""
        return (
            Chain(self.step, self.ahead + 1, self.behind),
            Chain(self.step, self.ahead, self.behind + 1),
        )


@dataclass(frozen=True)
class DarkestSearch(PictureRaster):
    """Search for exposures in a picture of the darkest values, on a raster.

    Attributes:
        length: The robot's length [m].
    """

    length: float

    @cached_property
    def floor(self) -> FloorColours:
        """Colour model of the floor."""
        return FloorColours.of(
            self.picture, self.used, width=self.length / self.plane.cell, noise=3.0
        )

    @cached_property
    def oddness(self) -> NDArray[np.float32]:
        """Squared Mahalanobis distance of each colour from the floor's."""
        return self.floor.oddness(self.picture)

    @cached_property
    def dark_things(self) -> Array:
        """Density of the colours that are not the floor's, at every point."""
        odd = self.used & (self.oddness > _ODD)
        return ColourDensity.of(self.picture[odd], blur=1.2)(self.picture)

    @cached_property
    def bare(self) -> NDArray[np.float32]:
        """Log density of the picture where there is no exposure."""
        known = _FLOOR_SHARE * self.floor.density(self.picture)
        return np.log(known + (1 - _FLOOR_SHARE) * self.dark_things).astype(np.float32)

    def find(self, anchor: Array) -> Array:
        """Find all exposures.

        Args:
            anchor: x, y [m] and yaw [rad] of an exposure that shows how the robot looks.

        Returns:
            Poses, that one first, shape (n, 3).
        """
        sets = [anchor[None]]
        for first in self.first_steps(anchor):
            ahead = self.followed([anchor, first])
            behind = self.followed([ahead[1], anchor])[2:]
            chain = Chain.through(ahead)
            steady = [self.longest(anchor, way) for way in (chain, chain.with_some_between)]
            sets += [np.array(ahead + behind), *(way.poses(anchor) for way in steady)]
        return self.polished(max(sets, key=self.worth))

    def worth(self, poses: Array) -> float:
        """Compute the score of a set of exposures with the penalty for their number.

        It is -inf where two exposures are in one place.
        """
        if not are_apart(poses, self.length):
            return -np.inf
        return self.value(poses) - LEAST_GAIN * (len(poses) - 1)

    def first_steps(self, anchor: Array) -> list[Array]:
        """Find candidate poses for the exposure next to the known one."""
        look = self.look(anchor[None])
        tried = beside(anchor, self.length, spacing=self.length / 20)
        return self.best_of(tried, look, self.cover(anchor[None], look), most=_FIRST_STEPS)

    def followed(self, poses: list[Array]) -> list[Array]:
        """Extend a chain from its last pose by its last step until no exposure is found."""
        while len(poses) < MOST_EXPOSURES:
            known = np.array(poses)
            look = self.look(known)
            expected = continued(poses[-2], poses[-1])
            cover = self.cover(known, look)
            found = self.best_of(nearby(expected, self.length), look, cover, most=2)
            new = next((pose for pose in found if is_near(pose, expected, self.length)), None)
            if new is None or distances(known, new).min() < LEAST_STEP * self.length:
                break
            poses.append(new)
        return poses

    def best_of(self, tried: Array, look: TopColours, cover: Cover, *, most: int) -> list[Array]:
        """Improve the likeliest of many candidate poses by local search.

        Args:
            tried: Candidate poses, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top.
            cover: The exposures that are known already.
            most: Most candidates to improve.

        Returns:
            Improved poses whose log odds are at least `LEAST_ODDS`, the likeliest first.
        """
        odds = self.odds(tried, look.thinned(), cover, self.body.thinned())
        starts = apart(tried, odds, 0.19 * self.length, most=most)

        def value(pose: Array) -> float:
            return float(self.gains(pose[None], look, cover, self.body)[0][0])

        found = [improved(value, start, reach=CLIMB, tries=90)[0] for start in starts]
        if not found:
            return []
        held = self.odds(np.array(found), look, cover, self.body)
        order = np.argsort(-held)
        return [found[k] for k in order if held[k] >= LEAST_ODDS]

    def longest(self, anchor: Array, chain: Chain) -> Chain:
        """Fit a chain and lengthen it at either end while the likelihood of the picture rises.

        Args:
            anchor: Pose of the known exposure, shape (3,) [m, m, rad].
            chain: Chain to start from.
        """
        chain = self.fitted(anchor, chain)
        worth = self.worth(chain.poses(anchor))
        while chain.ahead + chain.behind < MOST_EXPOSURES:
            tried = [self.fitted(anchor, longer) for longer in chain.longer]
            values = [self.worth(way.poses(anchor)) for way in tried]
            if max(values) <= worth:
                break
            chain, worth = tried[int(np.argmax(values))], max(values)
        return chain

    def fitted(self, anchor: Array, chain: Chain) -> Chain:
        """Fit the step of a chain by maximum likelihood of the picture.

        Args:
            anchor: Pose of the known exposure, shape (3,) [m, m, rad].
            chain: Chain to start from; the numbers of exposures are kept.
        """

        def value(step: Array) -> float:
            return self.value(Chain(step, chain.ahead, chain.behind).poses(anchor))

        step, _ = improved(value, chain.step, reach=(0.02, 0.01, 0.08, 0.02), tries=70)
        return Chain(step, chain.ahead, chain.behind)

    def polished(self, poses: Array) -> Array:
        """Refine every pose but the first by itself; drop those that are not likely enough."""
        step, order = usual_step(poses), list(order_exposures(poses))
        for k in range(1, len(poses)):
            poses = self.settled(poses, k, step, order)
        return poses[self.own_odds(poses) >= LEAST_ODDS]

    def settled(self, poses: Array, k: int, step: float, order: list[int]) -> Array:
        """Refine the pose of one exposure, with the others fixed.

        The rim of the robot a little off its place looks like the robot, since sides and legs of
        one exposure darken the tops of others. Therefore steps that differ from their neighbours
        are penalised.

        Args:
            poses: All exposures, shape (n, 3) [m, m, rad].
            k: Index of the exposure to refine.
            step: Usual distance between exposures [m].
            order: Indices of the exposures in order of the walk.

        Returns:
            All exposures with the refined one, shape (n, 3).
        """
        look = self.look(poses)
        cover = self.cover(np.delete(poses, k, axis=0), look)
        around = self.best_of(nearby(poses[k], 0.7 * step), look, cover, most=1)

        def value(pose: Array) -> float:
            changed = np.concatenate((poses[:k], pose[None], poses[k + 1 :]))
            return self.value(changed) - UNSTEADY * unsteadiness(changed[order])

        near = [pose for pose in around if is_near(pose, poses[k], 0.7 * step)]
        start = max((poses[k], *near), key=value)
        best, _ = improved(value, start, reach=_POLISH, tries=35)
        return np.concatenate((poses[:k], best[None], poses[k + 1 :]))

    def own_odds(self, poses: Array) -> Array:
        """Compute the log odds of each exposure given all others; infinite for the first."""
        look = self.look(poses)
        odds = [np.inf]
        for k in range(1, len(poses)):
            cover = self.cover(np.delete(poses, k, axis=0), look)
            odds.append(float(self.odds(poses[k][None], look, cover, self.body)[0]))
        return np.array(odds)

    def look(self, poses: Array) -> TopColours:
        """Estimate the robot's colours from all exposures, the known one first.

        Where the robot has the floor's colour it may be brighter than that; its colour is then
        unknown.
        """
        seen = np.array([self.body.read(self.picture, self.plane, pose) for pose in poses])
        odd = np.array([self.body.read(self.oddness, self.plane, pose) for pose in poses])
        own = np.where((odd[0] < _LIKE_FLOOR)[..., None], _OPEN, seen[0])
        brightest = np.where((odd.min(axis=0) < _LIKE_FLOOR)[..., None], _OPEN, seen.max(axis=0))
        return TopColours(own.astype(np.float32), brightest.astype(np.float32))

    def cover(self, poses: Array, look: TopColours) -> Cover:
        """Compute the darkest of several exposures at every point of the raster.

        Args:
            poses: The exposures, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top.
        """
        own, brightest = (np.full_like(self.picture, _OPEN) for _ in range(2))
        for pose in poses:
            for layer, values in ((own, look.own), (brightest, look.brightest)):
                window, laid = self.body.laid(_OPEN - values, self.plane, pose)
                layer[window] = np.minimum(layer[window], _OPEN - laid)
        log_density = self.bare.copy()
        on = brightest.max(axis=-1) < _OPEN - 100
        log_density[on] = self.log_density(
            self.picture[on], own[on], brightest[on], self.dark_things[on]
        )
        return Cover(own, brightest, log_density)

    def shown(self, poses: Array, k: int) -> NDArray[np.bool_]:
        """Compute the mask of points at which an exposure is the darkest and has its colour.

        Points of the first exposure that others darken are left out: their colours are not its own.

        Args:
            poses: All exposures, the first one known, shape (n, 3) [m, m, rad].
            k: Index of the exposure.

        Returns:
            Mask on the picture's raster, shape (rows, columns).
        """
        look = self.look(poses)
        others = self.cover(np.delete(poses, k, axis=0), look).brightest
        own, clear = np.full_like(self.picture, _OPEN), np.zeros(self.used.shape, np.float32)
        for layer, values in ((own, _OPEN - look.own), (clear, self.clear(poses, look))):
            window, laid = self.body.laid(values, self.plane, poses[k])
            layer[window] = laid
        same = (np.abs(self.picture - (_OPEN - own)) < _FAR * NOISE).all(axis=-1)
        darkest = ((_OPEN - own) <= others + _CLAIM).all(axis=-1)
        return same & (clear > 0.9) & darkest & self.used

    def clear(self, poses: Array, look: TopColours) -> NDArray[np.float32]:
        """Compute the mask of points of the robot at which the known exposure is the darkest.

        Args:
            poses: All exposures, the first one known, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top.

        Returns:
            1 where it is the darkest, else 0, on the robot's raster.
        """
        others = self.cover(poses[1:], look).brightest
        around = self.body.read(others, self.plane, poses[0])
        return np.asarray((look.own <= around + _CLAIM).all(axis=-1), dtype=np.float32)

    def value(self, poses: Array) -> float:
        """Compute the log likelihood ratio of exposures, in units of one exposure's points."""
        look = self.look(poses)
        windows = [self.body.window(self.plane, pose) for pose in poses]
        part = self.part(*(
            slice(min(w[k].start for w in windows), max(w[k].stop for w in windows))
            for k in (0, 1)
        ))  # fmt: skip
        gain = (part.cover(poses, look).log_density - part.bare)[part.used]
        return float(gain.sum()) / self.body.x.size

    def part(self, rows: slice, columns: slice) -> "DarkestSearch":
        """Crop the raster; the models of the floor's and of dark colours stay those of the whole.

        Args:
            rows: Rows to keep.
            columns: Columns to keep.
        """
        window = (rows, columns)
        part = replace(
            self, plane=self.plane.part(rows, columns),
            picture=self.picture[window], used=self.used[window],
        )  # fmt: skip
        known = {"bare": self.bare, "dark_things": self.dark_things, "oddness": self.oddness}
        part.__dict__.update({name: layer[window] for name, layer in known.items()})
        return part

    def odds(self, poses: Array, look: TopColours, cover: Cover, body: BodyRaster) -> Array:
        """Compute the log odds of one more exposure, mean over the points that it claims.

        Args:
            poses: Candidate poses, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top, on the points of `body`.
            cover: The exposures that are known already.
            body: Points of the robot's top to compare.

        Returns:
            Log odds, shape (n,) [-]; -inf where too little is claimed or inside the picture.
        """
        gain, claim, inside = self.gains(poses, look, cover, body)
        enough = (claim >= LEAST_CLAIM) & (inside >= _LEAST_SEEN)
        return np.where(enough, gain / np.maximum(claim, LEAST_CLAIM), -np.inf)

    def gains(
        self, poses: Array, look: TopColours, cover: Cover, body: BodyRaster
    ) -> tuple[Array, Array, Array]:
        """Compute by how much one more exposure raises the log density, for each of many poses.

        Args:
            poses: Candidate poses, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top, on the points of `body`.
            cover: The exposures that are known already.
            body: Points of the robot's top to compare.

        Returns:
            Gain of log density, mean over the exposure's points; shares of them that it claims,
            and that are in the picture. Each of shape (n,) [-].
        """
        place = body.on(self.plane, poses)
        inside = sample(self.used.astype(np.float32), place) > 0.9
        seen, dark, before = (
            sample(layer, place)
            for layer in (self.picture, self.dark_things.astype(np.float32), cover.log_density)
        )
        others = sample(cover.brightest, place)
        own = np.minimum(look.own, sample(cover.own, place))
        brightest = np.minimum(look.brightest, others)
        on = inside & (brightest.max(axis=-1) < _OPEN - 100)
        gain = np.where(on, self.log_density(seen, own, brightest, dark) - before, 0.0)
        claimed = on & (brightest < others - _CLAIM).any(axis=-1)
        return tuple(field.mean(axis=(1, 2)) for field in (gain, claimed, inside))

    @staticmethod
    def log_density(
        seen: NDArray[np.float32], own: NDArray[np.float32], brightest: NDArray[np.float32],
        dark_things: Array,
    ) -> Array:  # fmt: skip
        """Compute the log density of colours at points that exposures cover.

        Args:
            seen: Colours of the picture, shape (..., 3) [grey levels].
            own: Colours there by the known exposure, shape (..., 3).
            brightest: Colours there by the brightest of all exposures, shape (..., 3).
            dark_things: Density of the colours that are not the floor's, shape (...).

        Returns:
            Log density, shape (...).
        """
        shows = _OWN_LOOK * robot_density(seen - own)
        shows += (1 - _OWN_LOOK) * robot_density(seen - brightest)
        beyond = np.clip((seen - brightest).max(axis=-1) / NOISE - 1.0, 0.0, 3.5)
        hidden = (1 - _SEEN) * np.exp(-0.5 * beyond**2) + _BRIGHTER
        return np.log(_SEEN * shows + hidden * np.maximum(dark_things, 1e-12))
