# SPDX-License-Identifier: MIT
"""Least standard deviation of a drawn walk's last pose: of an estimator told all true covariances.

The estimator knows the family that courses are drawn from, the size of the gait's sway, and how
far edges, marks, lens and the rest scatter, in this walk; what it does not know are their values.
Its covariance is that of the linear Gaussian problem about the truth (the Bayesian Cramér-Rao
bound), P = (P0^-1 + J' R^-1 J)^-1, with J the derivative of all pixels by all unknowns, P0 the
covariance of what is told and R that of the pixels. Place and heading at the start and the length
of the course are unknown to it, and by how much the body is turned against its course, as nobody
tells that a robot which slips moves straight ahead. Like `world`, it shares nothing with the
tracker.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from benchmarks.accuracy.drawn_walks.world import (
    TOP_HEIGHT,
    WOBBLE,
    DrawnWalk,
    on_body,
    on_floor,
    outwards,
    project,
    rotation,
)
from model.arrays import Array

UNKNOWN = 1.0
"""Standard deviation of what is not told at all [m, rad, -]."""
EXACT_PX = 1e-3
"""Standard deviation of pixels that are known exactly [px]."""


@dataclass(frozen=True)
class Clicks:
    """What is seen of a robot without a marker.

    Attributes:
        corners: x and y of its top's corners in the body frame, shape (4, 2) [m].
        sd: Standard deviation of a click on one of them [px].
        found_sd: Standard deviation of a place of the top found again in a photograph [px].
        scale_sd: Standard deviation of the size at which it is found [-].
        found: Numbers of the photographs, and of the annotated one whose places are found there.
    """

    corners: Array
    sd: float
    found_sd: float
    scale_sd: float
    found: Sequence[tuple[int, int]]

    @property
    def annotated(self) -> list[int]:
        """Numbers of the photographs that are clicked on."""
        return sorted({number for _, number in self.found})


@dataclass
class _Unknowns:
    """Names, standard deviations and places of all unknowns in one vector of deviations."""

    sd: list[float] = field(default_factory=list)
    at: dict[str, slice] = field(default_factory=dict)

    def also(self, name: str, sd: Sequence[float] | Array) -> None:
        """Append unknowns of a name."""
        self.at[name] = slice(len(self.sd), len(self.sd) + len(sd))
        self.sd.extend(float(each) for each in sd)


def least_sd(walk: DrawnWalk, clicks: Clicks | None = None) -> Array:
    """Compute the least standard deviation of the last pose.

    Args:
        walk: The walk.
        clicks: What is seen of a robot without a marker; None for one with a marker.

    Returns:
        Of x, y [m] and yaw [rad], shape (3,).
    """
    unknowns = _unknowns(walk, clicks)
    seen = _seen(walk, unknowns, clicks)
    sd = np.array(unknowns.sd)
    sd[sd == 0] = 1e-12  # known exactly
    steps = 1e-3 * np.minimum(sd, 0.1)
    photo = np.repeat([each.photo for each in seen(np.zeros(len(sd)))], 8)
    own = np.array([np.arange(len(sd))[unknowns.at[f"body {k}"]] for k in range(len(walk.t))])
    J = sd * _derivative(
        lambda u: np.concatenate([each.pixels.ravel() for each in seen(u)]), steps, own, photo
    )
    noise = np.asarray(block_diag(*_noise(walk, clicks, seen(np.zeros(len(sd))))), np.float64)
    covariance = np.linalg.inv(np.eye(len(sd)) + J.T @ np.linalg.solve(noise, J))
    last = sd * _derivative(
        lambda u: _bodies(walk, unknowns, u)[-1, [0, 1, 5]], steps, own,
        np.full(3, len(walk.t) - 1),
    )  # fmt: skip
    return np.sqrt(np.diag(last @ covariance @ last.T))


def _derivative(
    function: Callable[[Array], Array], steps: Array, own: NDArray[np.intp], photo: NDArray[np.intp]
) -> Array:
    """Differentiate values by all unknowns; those of one photograph change its values alone.

    Args:
        function: Computes the values, shape (n,), from the deviations of the unknowns, shape (m,).
        steps: Steps of the unknowns, shape (m,).
        own: Indices of the unknowns of each photograph, shape (photos, 7).
        photo: Photograph of each value, shape (n,).

    Returns:
        Derivatives, shape (n, m).
    """

    def change(unknowns: NDArray[np.intp]) -> Array:
        """Compute by how much the values change with a step of some unknowns, shape (n,)."""
        u = np.zeros(len(steps))
        u[unknowns] = steps[unknowns]
        return (function(u) - function(-u)) / 2

    derivative = np.zeros((len(photo), len(steps)))
    for k in np.setdiff1d(np.arange(len(steps)), own):
        derivative[:, k] = change(np.array([k])) / steps[k]
    rows = np.arange(len(photo))[photo >= 0]
    for together in own.T:  # one step moves the same unknown of all photographs
        k = together[photo[rows]]
        derivative[rows, k] = change(together)[rows] / steps[k]
    return derivative


def _unknowns(walk: DrawnWalk, clicks: Clicks | None) -> _Unknowns:
    s, unknowns = walk.spreads, _Unknowns()
    unknowns.also("lens", walk.lens.sd)
    unknowns.also("camera", 6 * [UNKNOWN])
    for number in walk.told.marks:
        unknowns.also(f"mark {number}", (s.tape, s.tape, s.mark_turn, s.mark_side, s.edges))
    unknowns.also("edges", [s.edges])
    unknowns.also("mean", (s.height, s.tilt, s.tilt))
    # Heading, turn, period and phase of speed, period of turn: uniform, as drawn.
    spread = np.array([2.4, 22.0, 6.0, 30.0]) / np.sqrt(12)
    unknowns.also("course", (UNKNOWN, *spread))
    unknowns.also("start", 4 * [UNKNOWN])  # x, y, length, turn of the body against its course
    for k in range(len(walk.t)):
        unknowns.also(f"body {k}", (*WOBBLE, s.bounce, s.tilt, s.tilt, s.edges))
    if clicks is None:
        unknowns.also("robot", (s.side, s.place, s.place, s.turn))
    else:
        for k in clicks.annotated:
            unknowns.also(f"places {k}", 8 * [UNKNOWN])
    return unknowns


def _bodies(walk: DrawnWalk, unknowns: _Unknowns, u: Array) -> Array:
    """Return x, y, z, roll, pitch, yaw of the body in each photograph, deviations u added."""
    at, course = unknowns.at, walk.course
    heading, turn, speed_period, speed_phase, turn_period = u[at["course"]]
    x, y, longer, aside = u[at["start"]]
    moved = replace(
        course, heading=course.heading + heading, turn=course.turn + turn,
        speed_period=course.speed_period + speed_period,
        speed_phase=course.speed_phase + speed_phase, turn_period=course.turn_period + turn_period,
    )  # fmt: skip
    along = moved.poses(walk.t, walk.scale * (1 + longer)) - course.poses(walk.t, walk.scale)
    bodies = walk.bodies + np.array([x, y, *u[at["mean"]], aside])
    bodies[:, [0, 1, 5]] += along
    for k in range(len(bodies)):
        bodies[k, [0, 1, 5, 2, 3, 4]] += u[at[f"body {k}"]][:6]
    return bodies


class _Seen(NamedTuple):
    """Four corners or places, shape (4, 2) [px], and the photograph; -1 for marks of the floor."""

    photo: int
    pixels: Array


def _seen(
    walk: DrawnWalk, unknowns: _Unknowns, clicks: Clicks | None
) -> Callable[[Array], list[_Seen]]:
    """Return what computes all that is seen from the deviations of the unknowns."""
    at = unknowns.at

    def in_picture(u: Array, points: Array) -> Array:
        """Project points of the floor frame, shape (n, 3) [m], to pixels, shape (n, 2)."""
        R, eye = walk.camera
        turned = np.eye(3) + _cross(u[at["camera"]][:3])
        return project(walk.lens.values + u[at["lens"]], turned @ R, eye + u[at["camera"]][3:],
                       points)  # fmt: skip

    def parts(u: Array) -> Iterator[_Seen]:
        """Yield the floor's marks, then what is seen of the robot."""
        common, bodies = float(u[at["edges"]][0]), _bodies(walk, unknowns, u)
        for number, mark in walk.told.marks.items():
            own = u[at[f"mark {number}"]]
            yield _Seen(-1, outwards(in_picture(u, on_floor(mark + own[:4])), common + own[4]))
        if clicks is None:
            robot = np.array([0.12, 0.0, 0.0, 0.0]) + u[at["robot"]]
            for k, state in enumerate(bodies):
                own = u[at[f"body {k}"]][6]
                yield _Seen(k, outwards(in_picture(u, on_body(robot, state)), common + own))
            return
        places = {k: clicks.corners + u[at[f"places {k}"]].reshape(4, 2) for k in clicks.annotated}
        for k in clicks.annotated:
            for top in (clicks.corners, places[k]):
                yield _Seen(k, in_picture(u, _on_top(top, bodies[k])))
        for k, annotated in clicks.found:
            yield _Seen(k, in_picture(u, _on_top(places[annotated], bodies[k])))

    return lambda u: list(parts(u))


def _noise(walk: DrawnWalk, clicks: Clicks | None, seen: Sequence[_Seen]) -> list[Array]:
    """Return the covariance of each that is seen, shapes (8, 8) [px²]."""
    noise = [walk.floor[0][number].covariance for number in walk.told.marks]
    if clicks is None:
        return noise + [sight.covariance for sight in walk.robot]
    noise += [sd**2 * np.eye(8) for _ in clicks.annotated for sd in (clicks.sd, EXACT_PX)]
    for _, pixels in seen[len(noise) :]:
        larger = (pixels - pixels.mean(axis=0)).ravel()
        own = clicks.found_sd**2 * np.eye(8)
        noise.append(own + clicks.scale_sd**2 * np.outer(larger, larger))
    return noise


def _on_top(places: Array, state: Array) -> Array:
    """Put places on the body's top, shape (n, 2), into the floor frame, shape (n, 3) [m]."""
    flat = np.column_stack((places, np.full(len(places), TOP_HEIGHT)))
    return flat @ rotation(state).T + state[:3]


def _cross(v: Array) -> Array:
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
