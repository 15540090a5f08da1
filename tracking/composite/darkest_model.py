# SPDX-License-Identifier: MIT
"""Likelihood of a picture that holds, of each pixel, the darkest value of all exposures.

Where exposures overlap, each shows only where it is the darkest, and the picture is nowhere
brighter than any of them. A set of exposures is scored by the log likelihood ratio of the picture
against the bare floor, summed over the points of its raster. A point that some exposure covers has
the darkest of their colours; or a darker one, from the colours near the robot, where a leg, a side
or a shadow hides it; hardly ever a brighter one.

The robot's colours come from one known exposure, which others partly cover; a covered point takes
the brightest colour that other exposures show of it.
"""

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.template import sample
from tracking.composite.body_raster import BodyRaster
from tracking.composite.colours import NOISE, FloorColours, colour_density, robot_density
from tracking.composite.reading import Reading

LEAST_CLAIM = 0.12
"""Least share of an exposure's points at which it must be the darkest [-]."""

_SEEN = 0.6  # share of the robot's own points that show it and not a darker thing
_OWN_LOOK = 0.6  # weight of the known exposure's colours against the brightest seen
_BRIGHTER = 0.01  # how often a point is brighter than it could be
_FLOOR_SHARE = 0.85
_OUTLIER, _LIKE_FLOOR = 20.0, 12.0  # squared distances from the floor's colours
_OPEN = 1000.0  # stands for no exposure: brighter than any colour
_LEAST_SEEN = 0.6  # share of an exposure that must be in the picture
_FAR = 2.5  # in standard deviations: beyond it the colour differs
_CLAIM = 6.0  # a point darker than others by this is claimed [grey levels]


class TopColours(NamedTuple):
    """Colours of the robot's top on its raster, shape (rows, columns, 3) each [grey levels].

    Attributes:
        own: Colours in the known exposure.
        brightest: Brightest colours of all exposures; 1000 in either where unknown, since there
            the floor's colour is seen.
    """

    own: NDArray[np.float32]
    brightest: NDArray[np.float32]

    def thinned(self) -> "TopColours":
        """Return the colours at every second point in both directions (`BodyRaster.thinned`)."""
        return TopColours(self.own[1::2, 1::2], self.brightest[1::2, 1::2])


class Cover(NamedTuple):
    """Darkest colours of several exposures on the picture's raster.

    Attributes:
        own: Darkest by `TopColours.own`, about 1000 where no exposure lies or its colour is
            unknown, shape (rows, columns, 3).
        brightest: Darkest by `TopColours.brightest`, likewise.
        log_density: Log density of the picture given the exposures, where none lies that of bare
            floor, shape (rows, columns).
    """

    own: NDArray[np.float32]
    brightest: NDArray[np.float32]
    log_density: NDArray[np.float32]


class DarkestModel(Reading):
    """Likelihood of a picture of darkest values, given poses of exposures."""

    @cached_property
    def floor(self) -> FloorColours:
        """Colour model of the floor, light varying over the robot's length."""
        return FloorColours.of(
            self.picture, self.used, width=self.length / self.plane.cell, noise=3.0
        )

    @cached_property
    def floor_distance(self) -> NDArray[np.float32]:
        """Squared Mahalanobis distance of each point's colour from the floor's light there."""
        return self.floor.floor_distance(self.picture)

    @cached_property
    def dark_things(self) -> Array:
        """Density of each point's colour among those that are not the floor's, (rows, columns)."""
        other = self.used & (self.floor_distance > _OUTLIER)
        return colour_density(self.picture[other], self.picture, blur=1.2)

    @cached_property
    def bare(self) -> NDArray[np.float32]:
        """Log density of the picture's colours on bare floor, shape (rows, columns)."""
        known = _FLOOR_SHARE * self.floor.density(self.picture)
        return np.log(known + (1 - _FLOOR_SHARE) * self.dark_things).astype(np.float32)

    def look(self, poses: Array) -> TopColours:
        """Estimate the robot's colours from the picture at all poses (n, 3), the known one first.

        Where the picture has the floor's colour the robot may be brighter than the floor; its
        colour there is unknown.
        """
        seen = np.array([self.body.read(self.picture, pose) for pose in poses])
        odd = np.array([self.body.read(self.floor_distance, pose) for pose in poses])
        own = np.where((odd[0] < _LIKE_FLOOR)[..., None], _OPEN, seen[0])
        brightest = np.where((odd.min(axis=0) < _LIKE_FLOOR)[..., None], _OPEN, seen.max(axis=0))
        return TopColours(own.astype(np.float32), brightest.astype(np.float32))

    def cover(self, poses: Array, look: TopColours) -> Cover:
        """Compute the darkest colours of several exposures at every point of the raster.

        Args:
            poses: The exposures, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top.
        """
        own, brightest = (np.full_like(self.picture, _OPEN) for _ in range(2))
        for pose in poses:
            for layer, values in ((own, look.own), (brightest, look.brightest)):
                window, laid = self.body.laid(_OPEN - values, pose)
                layer[window] = np.minimum(layer[window], _OPEN - laid)
        log_density = self.bare.copy()
        on = brightest.max(axis=-1) < _OPEN - 100
        log_density[on] = self.log_density(
            self.picture[on], own[on], brightest[on], self.dark_things[on]
        )
        return Cover(own, brightest, log_density)

    def value(self, poses: Array) -> float:
        """Compute the log likelihood ratio of exposures (n, 3) to bare floor, per robot point.

        The first exposure is the known one. The sum over all points used is divided by the number
        of points on the robot's raster.
        """
        gain = self.cover(poses, self.look(poses)).log_density - self.bare
        return float(gain[self.used].sum()) / self.body.x.size

    def odds(self, poses: Array, look: TopColours, cover: Cover, body: BodyRaster) -> Array:
        """Compute the log odds of one more exposure, mean over points where it is the darkest.

        Args:
            poses: Candidate poses, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top, on the points of `body`.
            cover: Darkest colours of the exposures known already.
            body: Points of the robot's top to compare.

        Returns:
            Gain of log density, sum over its points, over the number of points where it is the
            darkest, shape (n,) [-]; -inf where these are less than `LEAST_CLAIM` of its points, or
            less than 0.6 of it is inside the picture.
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
            cover: Darkest colours of the exposures known already.
            body: Points of the robot's top to compare.

        Returns:
            Gain of log density, mean over the exposure's points; share of its points where it is
            the darkest; share inside the picture. Shape (n,) each [-].
        """
        place = body.on(poses)
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
            own: Colours expected from the known exposure, shape (..., 3).
            brightest: Colours expected from the brightest of all exposures, shape (..., 3).
            dark_things: Density of `seen` among colours that are not the floor's, shape (...).

        Returns:
            Log density, shape (...).
        """
        shows = _OWN_LOOK * robot_density(seen - own)
        shows += (1 - _OWN_LOOK) * robot_density(seen - brightest)
        beyond = np.clip((seen - brightest).max(axis=-1) / NOISE - 1.0, 0.0, 3.5)
        hidden = (1 - _SEEN) * np.exp(-0.5 * beyond**2) + _BRIGHTER
        return np.log(_SEEN * shows + hidden * np.maximum(dark_things, 1e-12))

    def shown(self, poses: Array, k: int) -> NDArray[np.bool_]:
        """Compute the mask of points where an exposure is the darkest and has the robot's colour.

        Points of the robot that others darken in the first exposure, and points not `used`, are
        left out: their colours there are not the robot's.

        Args:
            poses: All exposures, the first one known, shape (n, 3) [m, m, rad].
            k: Index of the exposure.

        Returns:
            Mask on the picture's raster, shape (rows, columns).
        """
        look = self.look(poses)
        others = self.cover(np.delete(poses, k, axis=0), look).brightest
        own, clear = np.full_like(self.picture, _OPEN), np.zeros(self.used.shape, np.float32)
        for layer, values in ((own, _OPEN - look.own), (clear, self.undarkened(poses, look))):
            window, laid = self.body.laid(values, poses[k])
            layer[window] = laid
        same = (np.abs(self.picture - (_OPEN - own)) < _FAR * NOISE).all(axis=-1)
        darkest = ((_OPEN - own) <= others + _CLAIM).all(axis=-1)
        return same & (clear > 0.9) & darkest & self.used

    def undarkened(self, poses: Array, look: TopColours) -> NDArray[np.float32]:
        """Compute the mask of points of the robot at which the known exposure is the darkest.

        Args:
            poses: All exposures, the first one known, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top.

        Returns:
            1 where the known exposure is the darkest, else 0, on the robot's raster.
        """
        others = self.cover(poses[1:], look).brightest
        around = self.body.read(others, poses[0])
        return np.asarray((look.own <= around + _CLAIM).all(axis=-1), dtype=np.float32)

    def own_odds(self, poses: Array) -> Array:
        """Compute the log odds of each exposure (n, 3) given all others; inf for the first."""
        look = self.look(poses)
        odds = [np.inf]
        for k in range(1, len(poses)):
            cover = self.cover(np.delete(poses, k, axis=0), look)
            odds.append(float(self.odds(poses[k][None], look, cover, self.body)[0]))
        return np.array(odds)
