# SPDX-License-Identifier: MIT
"""One picture with all exposures of a walk in it: find each, and put them in order.

Exposures are found one after another, the clearest first; where one was found the picture is taken
from it, and what is left is searched again, so that an exposure half under its successor is judged
by the half that shows. Nothing is accepted by less than 40 % of its top, nor by its place alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from tracking.body import (
    Alignment,
    BodyTemplate,
    align,
    floor_in_view,
    match_turned,
)
from tracking.camera.lens import Array, Camera, CameraPose, project
from tracking.errors import CompositeError
from tracking.pose import BodyPrior, rotation_with_derivatives

WHOLE_SCORE = 0.8
"""Least correlation of an exposure that shows whole [-]."""

PART_SCORE = 0.88
"""Least correlation of the visible part of one that does not [-]."""

_MOST_STARTS = 40
_EXACT_ORDER = 12


@dataclass(frozen=True)
class Exposure:
    """One exposure of the robot in a composite picture.

    Attributes:
        alignment: Where it is.
        visible: Share of its top that shows [-].
    """

    alignment: Alignment
    visible: float


def find_exposures(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, template: BodyTemplate,
    prior: BodyPrior, rim: float = 0.0, rounds: int = 4,
    near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Exposure, ...]:  # fmt: skip
    """Find all exposures of the robot in one picture.

    Args:
        pixels: The picture, BGR, shape (height, width, 3).
        camera: The lens.
        view: Where the camera stood.
        template: The robot's picture, or its marker's (`tracking.body.marker_template`).
        prior: Height and tilt.
        rim: How far the robot reaches beyond the template's plate; so much around an exposure that
            was found hides others [m].
        rounds: How often what is left is searched again.
        near: x and y near which to look [m]; the whole picture when None.
        reach: How far from there [m].

    Returns:
        The exposures, in the order in which they were found.

    Raises:
        CompositeError: When none is found.
    """
    height = prior.height + template.plate.height
    area = floor_in_view(camera, view, height, near, reach)
    starts = match_turned(
        pixels, camera, view, template=template, height=height, area=area, most=_MOST_STARTS
    )
    search = _Search(pixels, camera, view, template, prior, rim)
    found: list[Exposure] = []
    visible = np.ones(pixels.shape[:2], dtype=bool)
    for turn in range(rounds):
        new = search.once([*starts, *_predicted(found)], found, visible)
        if turn > 0 and not new:
            break
        found += new
        for exposure in new:
            visible &= ~search.covered(exposure.alignment)
    if not found:
        raise CompositeError(
            "no exposure of the robot is found in the composite picture; check the marker's number "
            "and dictionary, or annotate one exposure as template"
        )
    return tuple(found)


@dataclass(frozen=True)
class _Search:
    pixels: NDArray[np.uint8]
    camera: Camera
    view: CameraPose
    template: BodyTemplate
    prior: BodyPrior
    rim: float

    def once(
        self, starts: Sequence[Array], found: Sequence[Exposure], visible: NDArray[np.bool_]
    ) -> list[Exposure]:
        """Align every start and keep the good ones that do not lie on each other."""
        mask = None if visible.all() else visible
        candidates = []
        for start in starts:
            if any(_on(start, other.alignment, self.template) for other in found):
                continue
            alignment = align(
                self.pixels, self.camera, self.view, template=self.template, prior=self.prior,
                start=start, visible=mask,
            )  # fmt: skip
            if alignment is None:
                continue
            share = self.share(alignment, visible)
            if share >= 0.4 and alignment.score >= (WHOLE_SCORE if share > 0.95 else PART_SCORE):
                candidates.append(Exposure(alignment, share))
        return self.apart(candidates, found)

    def apart(self, candidates: Sequence[Exposure], found: Sequence[Exposure]) -> list[Exposure]:
        """Keep the clearest of candidates that lie on each other."""
        kept: list[Exposure] = []
        hidden = np.zeros(self.pixels.shape[:2], dtype=bool)
        for exposure in sorted(candidates, key=lambda e: -e.alignment.score):
            place = exposure.alignment.pose.planar
            if any(_on(place, other.alignment, self.template) for other in (*found, *kept)):
                continue
            if self.share(exposure.alignment, ~hidden) < 0.95:
                continue  # judged again in the next round, by the part that shows
            kept.append(exposure)
            hidden |= self.covered(exposure.alignment)
        return kept

    def outline(self, alignment: Alignment, rim: float) -> Array:
        """Compute the outline of the robot's top in the picture, widened by `rim` [m]."""
        plate = self.template.plate
        grow = np.array([[1, 1, 0], [1, -1, 0], [-1, -1, 0], [-1, 1, 0]]) * rim
        R, _ = rotation_with_derivatives(*alignment.pose.state[3:])
        corners = (plate.corners_body + grow) @ R.T + alignment.pose.state[:3]
        return project(self.camera, self.view, corners)

    def covered(self, alignment: Alignment) -> NDArray[np.bool_]:
        """Mark the pixels an exposure covers."""
        mask = np.zeros(self.pixels.shape[:2], dtype=np.uint8)
        outline = np.round(self.outline(alignment, self.rim + self.template.plate.margin))
        cv2.fillConvexPoly(mask, outline.astype(np.int32), (1,))
        return mask.astype(bool)

    def share(self, alignment: Alignment, visible: NDArray[np.bool_]) -> float:
        """Compute the share of an exposure's top that is visible."""
        mask = np.zeros(self.pixels.shape[:2], dtype=np.uint8)
        cv2.fillConvexPoly(mask, np.round(self.outline(alignment, 0.0)).astype(np.int32), (1,))
        own = mask.astype(bool)
        return float((own & visible).sum() / max(int(own.sum()), 1))


def _on(planar: Array, other: Alignment, template: BodyTemplate) -> bool:
    distance = np.hypot(*(planar[:2] - other.pose.planar[:2]))
    return bool(distance < 0.2 * template.plate.length)


def _predicted(found: Sequence[Exposure]) -> list[Array]:
    """Guess exposures between and beyond those found, from the steps between neighbours."""
    if len(found) < 3:
        return []
    poses = np.array([exposure.alignment.pose.planar for exposure in found])
    ordered = poses[list(order_exposures(poses))]
    steps = np.diff(ordered, axis=0)
    steps[:, 2] = np.angle(np.exp(1j * steps[:, 2]))
    typical = np.median(np.hypot(steps[:, 0], steps[:, 1]))
    guesses = [ordered[0] - steps[0], ordered[-1] + steps[-1]]
    for start, step in zip(ordered[:-1], steps, strict=True):
        parts = round(float(np.hypot(*step[:2]) / typical))
        guesses += [start + step * part / parts for part in range(1, parts)]
    return guesses


def order_exposures(poses: ArrayLike, *, heading_known: bool = True) -> tuple[int, ...]:
    """Order exposures along the walk.

    A step from one exposure to the next is judged by its length and by how well it follows the
    mean of both headings, as a chord follows an arc. Length alone goes astray wherever the path
    comes near itself.

    Args:
        poses: x, y [m] and yaw [rad] of the exposures, shape (n, 3).
        heading_known: Whether head and tail are told apart. If not, both directions along the
            robot are taken alike and the order may be the reverse.

    Returns:
        Numbers of the exposures, first to last.
    """
    places = np.asarray(poses, dtype=float).reshape(-1, 3)
    if len(places) < 3 and not heading_known:
        return tuple(range(len(places)))
    cost = _step_costs(places, heading_known)
    if len(places) <= _EXACT_ORDER:
        return _best_chain(cost)
    return _improved_chain(cost)


def _step_costs(places: Array, heading_known: bool) -> Array:
    """Compute the cost of a step from i to j, shape (n, n) [m]."""
    move = places[None, :, :2] - places[:, None, :2]
    distance = np.hypot(move[..., 0], move[..., 1])
    turn = np.angle(np.exp(1j * (places[None, :, 2] - places[:, None, 2])))
    if not heading_known:
        turn = 0.5 * np.angle(np.exp(2j * turn))
    heading = places[:, None, 2] + turn / 2
    chord = np.arctan2(move[..., 1], move[..., 0])
    along = np.cos(chord - heading)
    if not heading_known:
        along = np.abs(along)
    # A step sideways costs three times its length, one backwards seven times.
    cost = distance * (1 + 3 * (1 - along) + 2 * (1 - np.cos(turn)))
    np.fill_diagonal(cost, np.inf)
    return cost


def _best_chain(cost: Array) -> tuple[int, ...]:
    """Find the cheapest chain through all (Held and Karp 1962)."""
    n = len(cost)
    if n == 0:
        return ()
    total = np.full((1 << n, n), np.inf)
    came = np.zeros((1 << n, n), dtype=int)
    for last in range(n):
        total[1 << last, last] = 0.0
    for done in range(1, 1 << n):
        for after in range(n):
            if done >> after & 1:
                continue
            through = total[done] + cost[:, after]
            best = int(np.argmin(through))
            more = done | 1 << after
            if through[best] < total[more, after]:
                total[more, after], came[more, after] = through[best], best
    done, last = (1 << n) - 1, int(np.argmin(total[-1]))
    chain = [last]
    while done & (done - 1):
        before = int(came[done, last])
        done ^= 1 << last
        chain.append(before)
        last = before
    return tuple(chain[::-1])


def _improved_chain(cost: Array) -> tuple[int, ...]:
    """Chain nearest to nearest from every start; improve the best by moving stretches."""
    n = len(cost)
    chains = [_nearest_chain(cost, start) for start in range(n)]
    chain = min(chains, key=lambda c: _length(cost, c))
    improved = True
    while improved:
        improved = False
        for i in range(n):
            for j in range(i + 1, min(i + 4, n) + 1):
                stretch, rest = chain[i:j], chain[:i] + chain[j:]
                options = [rest[:k] + stretch + rest[k:] for k in range(len(rest) + 1)]
                options.append(chain[:i] + stretch[::-1] + chain[j:])
                best = min(options, key=lambda c: _length(cost, c))
                if _length(cost, best) < _length(cost, chain) - 1e-12:
                    chain, improved = best, True
    return tuple(chain)


def _nearest_chain(cost: Array, start: int) -> list[int]:
    chain, left = [start], set(range(len(cost))) - {start}
    while left:
        last = chain[-1]
        chain.append(min(left, key=lambda k: cost[last, k]))
        left.remove(chain[-1])
    return chain


def _length(cost: Array, chain: Sequence[int]) -> float:
    return float(cost[list(chain[:-1]), list(chain[1:])].sum())
