# SPDX-License-Identifier: MIT
"""Find and align exposures in a picture of the darkest values of all exposures.

While some exposures are still missing, their repeated pattern is mistaken for the robot's own.
Therefore exposures are not added one by one: whole chains of a steady step from the known exposure
on are compared by their likelihood (`darkest_model`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from model.arrays import Array
from tracking.composite.darkest_model import Cover, DarkestModel, TopColours
from tracking.composite.exposure import Exposure
from tracking.composite.known import LEAST_SCORE, LEVER
from tracking.composite.order import order_exposures
from tracking.composite.steps import (
    CLIMB,
    LEAST_STEP,
    MOST_EXPOSURES,
    apart,
    are_apart,
    beside,
    continued,
    distances,
    improved,
    is_near,
    nearby,
    steady_chain,
    step_between,
    unsteadiness,
    usual_step,
)

LEAST_ODDS = 0.25
"""Least log odds of an exposure, mean over the points where it is the darkest [-]."""

LEAST_GAIN = 0.15
"""Cost of each further exposure in log odds, mean over the points of one exposure [-]."""

UNSTEADY = 0.03
"""Cost of one unit of `unsteadiness` in log odds, mean over the points of one exposure [-]."""

DARKEST_SD = 1 / 40
"""Standard deviation of position where other things are as strong as the robot, in lengths of the
robot [-]."""

_SHOWN = 0.7  # share of a pixel's surroundings that must show the exposure
_FIRST_STEPS = 10
_POLISH = (0.006, 0.006, 0.05)


@dataclass(frozen=True)
class Chain:
    """Exposures at steady steps before and after the known one.

    Attributes:
        step: Step forward and left [m], its turn, and the change of turn from each step to the
            next [rad], shape (4,).
        ahead: Number of exposures after the known one, along the step.
        behind: Number of exposures before the known one, against the step.
    """

    step: Array
    ahead: int
    behind: int

    def poses(self, anchor: Array) -> Array:
        """Compute the poses of the exposures, the known one first, shape (n, 3)."""
        return steady_chain(anchor, self.step[:3], float(self.step[3]), self.ahead, self.behind)

    @classmethod
    def through(cls, poses: Sequence[Array]) -> "Chain":
        """Build a chain of the median step between poses in order, all ahead of the first.

        The turn does not change from step to step.
        """
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


class DarkestReading(DarkestModel):
    """Reading of a picture that holds, of each pixel, the darkest value of all exposures."""

    def find(self) -> Array:
        """Find the likeliest of many chains of exposures, then refine each pose.

        Returns:
            x, y [m] and yaw [rad], the known exposure first, shape (n, 3).
        """
        anchor = self.known.pose.planar
        sets = [anchor[None]]
        for first in self.first_steps(anchor):
            ahead = self.followed([anchor, first])
            behind = self.followed([ahead[1], anchor])[2:]
            chain = Chain.through(ahead)
            steady = [self.longest(anchor, way) for way in (chain, chain.with_some_between)]
            sets += [np.array(ahead + behind), *(way.poses(anchor) for way in steady)]
        return self.polished(max(sets, key=self.worth))

    def align(self, poses: Array) -> tuple[Exposure, ...]:
        """Align the part where each exposure is the darkest, twice; drop those that fail.

        The known one is dropped, too, if it fails.
        """
        found = self.aligned_among(poses)
        return self.aligned_among(np.array([each.planar for each in found]))

    def aligned_among(self, poses: Array) -> tuple[Exposure, ...]:
        """Align the part where each exposure is the darkest, given all poses (n, 3).

        The first pose is that of the known exposure. Exposures that do not align are left out.
        """
        known, found = self.known, []
        template = known.body_template(known.pixels)
        for k, pose in enumerate(poses):
            visible = known.on_photo(self.shown(poses, k), self.plane, pose) > _SHOWN
            alignment = known.aligned(pose, known.pixels, template, visible, least=LEAST_SCORE)
            if alignment is not None:
                widened = known.widened(alignment, DARKEST_SD, lever=LEVER)
                found.append(Exposure(widened, known.share(pose, visible)))
        return tuple(found)

    def worth(self, poses: Array) -> float:
        """Compute `value` of a set of exposures (n, 3) less `LEAST_GAIN` for each but the first.

        The result is -inf where two exposures are nearer than `LEAST_STEP` lengths of the robot.
        """
        if not are_apart(poses, self.length):
            return -np.inf
        return self.value(poses) - LEAST_GAIN * (len(poses) - 1)

    def first_steps(self, anchor: Array) -> list[Array]:
        """Find up to ten poses (3,) of the exposure next to the known one, the likeliest first."""
        look = self.look(anchor[None])
        tried = beside(anchor, self.length, spacing=self.length / 20)
        return self.best_of(tried, look, self.cover(anchor[None], look), most=_FIRST_STEPS)

    def followed(self, poses: list[Array]) -> list[Array]:
        """Extend poses, at least two in order, by their last step until no exposure is found.

        The list is extended in place, to at most `MOST_EXPOSURES`, and returned.
        """
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
        """Refine the likeliest of many candidate poses by maximising the likelihood.

        Args:
            tried: Candidate poses, shape (n, 3) [m, m, rad].
            look: Colours of the robot's top.
            cover: Darkest colours of the exposures known already.
            most: Largest number of candidates to refine.

        Returns:
            Refined poses whose log odds are at least `LEAST_ODDS`, the likeliest first.
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
        """Fit a chain and lengthen it at either end while `worth` rises.

        It is lengthened only below `MOST_EXPOSURES` exposures besides the known one.

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
            chain: Chain to start from; its numbers of exposures are kept.
        """

        def value(step: Array) -> float:
            return self.value(Chain(step, chain.ahead, chain.behind).poses(anchor))

        step, _ = improved(value, chain.step, reach=(0.02, 0.01, 0.08, 0.02), tries=70)
        return Chain(step, chain.ahead, chain.behind)

    def polished(self, poses: Array) -> Array:
        """Refine each pose but the first, one at a time; drop those below `LEAST_ODDS`."""
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
