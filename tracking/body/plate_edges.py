# SPDX-License-Identifier: MIT
"""Clicks on the corners of the robot's top, refined by the edges of the top in the photograph.

A person clicks to half a pixel; an edge of tens of pixels is seen to a tenth of one. Each side of
the outline is followed along its projection at the pose that the clicks give, which bends with the
lens. The estimate is Gaussian: the eight coordinates of the corners, with the clicks as prior, are
measured by the distances of the four edges from that outline at both ends. Errors of a side:

* scatter of the points along the edge;
* an offset of the whole side: the plate's thickness and its shadow (0.2 px and 0.4 % of the side);
* a tilt of the side (0.05 px and 0.1 %);
* offsets that opposite sides have in common, outwards: the plate is larger than stated, or was
  clicked inside its edges (1 px and 1 %). They change neither the place nor the turn of the plate.

A side without one clear edge is left out, and one whose edge the clicks and the other edges
contradict: it is another thing's. Where more than one is contradicted, the clicks are kept alone.
In several annotated photographs a plate's thickness offsets edges alike; that is not accounted for.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.stats import chi2

from model.arrays import Array
from tracking.body.annotated import AnnotatedPose
from tracking.body.template import sample
from tracking.camera.lens import project
from tracking.pose import body_to_floor

OFFSET_SD = (0.2, 0.004)
TILT_SD = (0.05, 0.001)
OUTLINE_SD = (1.0, 0.01)
"""Standard deviations of the errors of a side: in pixels, and as a part of its length."""

_REACH_SD = 3.0  # of clicks and outline: how far from the outline an edge is sought
_UNIT = 150.0  # px: sides that are longer are looked at in as many times larger steps
_STEP, _BLUR = 0.25, 0.7  # of profiles across an edge, in pixels of a side of 150 px, as below
_ENDS = 0.1  # part of a side at each end that is left out
_SHORTEST = 10.0  # side of the outline [px]
_AMBIGUOUS, _APART = 0.5, 1.5  # a second edge: part of the first one's slope, distance
_CLEAR = 6.0  # slope of the mean profile [grey levels]
_SEGMENTS, _FOLLOWED = 12, 0.7  # along an edge; least part of them on one line
_NEAR = (2.5, 1.5)  # reaches of the two passes along the line found
_ALARM, _ALARM_OF_SIDE = 1e-4, 1e-3  # probabilities


@dataclass(frozen=True)
class RefinedCorners:
    """Corners of the robot's top by clicks and edges.

    Attributes:
        corners_px: Corners u, v, in the order of the clicks, shape (4, 2) [px].
        covariance: Covariance of `corners_px.ravel()`, shape (8, 8) [px²].
        sides: Number of sides whose edge was used, 0 to 4.
        contradicts: Whether edges were found that the clicks contradict, and were left out.
        moved: Root mean square distance of the corners from the clicks [px].
    """

    corners_px: Array
    covariance: Array
    sides: int
    contradicts: bool = False
    moved: float = 0.0


@dataclass(frozen=True)
class _Edge:
    """Distance of an edge from its side of the outline, outwards, at both ends, (2,) [px].

    Its covariance (2, 2) has the side's own errors, not those that opposite sides have in common.
    """

    offsets: Array
    covariance: Array


def refine_corners(
    pixels: NDArray[np.uint8], clicked: AnnotatedPose, clicks_px: Array, *, sd_px: float
) -> RefinedCorners:
    """Refine clicks on the corners of the robot's top by its edges.

    Args:
        pixels: The photograph, BGR, shape (height, width, 3).
        clicked: The robot's pose by the clicks.
        clicks_px: Clicks u, v on the corners in order around the top, shape (4, 2) [px].
        sd_px: Standard deviation of u and of v of a click [px].

    Returns:
        The corners; the clicks with their covariance where a side is shorter than `_SHORTEST`, no
        edge is clear, or the edges contradict the clicks: all together with a probability below
        1e-4, or two sides with 1e-3.
    """
    clicks = np.asarray(clicks_px, dtype=float)
    kept = RefinedCorners(clicks, sd_px**2 * np.eye(8), 0)
    outline = [_side(clicked, k) for k in range(4)]
    lengths = [_length(side) for side in outline]
    if min(lengths) < _SHORTEST:
        return kept
    middle = np.mean([side[0] for side in outline], axis=0)
    edges = {}
    for k, side in enumerate(outline):
        reach = _REACH_SD * np.hypot(sd_px, _sd(OUTLINE_SD, lengths[k]))
        # An edge farther away than a quarter of the top is another one's.
        edge = _find_edge(pixels, side, _outwards(side, middle), min(reach, 0.25 * min(lengths)))
        if edge is not None:
            edges[k] = edge
    corners = np.array([side[0] for side in outline])
    missed = (clicks - corners).ravel()  # the outline is that of the pose, which clicks differ from
    found = len(edges)
    while edges:
        by_corner, noise = _measurement(outline, middle, edges)
        surprise = np.concatenate([edge.offsets for edge in edges.values()]) - by_corner @ missed
        information = np.linalg.inv(sd_px**2 * by_corner @ by_corner.T + noise)
        if surprise @ information @ surprise > chi2.isf(_ALARM, len(surprise)):
            return replace(kept, contradicts=True)
        worst = _contradicted(surprise, information)
        if worst is None:
            gain = sd_px**2 * by_corner.T @ information
            moved = (gain @ surprise).reshape(4, 2)
            covariance = sd_px**2 * (np.eye(8) - gain @ by_corner)
            rms = float(np.sqrt(np.mean(np.sum(moved**2, axis=1))))
            return RefinedCorners(
                clicks + moved, (covariance + covariance.T) / 2, len(edges), moved=rms
            )
        del edges[list(edges)[worst]]
        if found - len(edges) > 1:
            return replace(kept, contradicts=True)
    return kept


def _contradicted(surprise: Array, information: Array) -> int | None:
    """Return the place of the side that the others and the clicks contradict most.

    None where the surprise of that side has a probability of `_ALARM_OF_SIDE` or more.

    Args:
        surprise: Offsets of the sides less those of the clicks, two of each side, shape (2m,) [px].
        information: Inverse of its covariance, shape (2m, 2m).
    """
    pull = information @ surprise
    squares = [
        pull[k : k + 2] @ np.linalg.solve(information[k : k + 2, k : k + 2], pull[k : k + 2])
        for k in range(0, len(pull), 2)
    ]
    worst = int(np.argmax(squares))
    return worst if squares[worst] > chi2.isf(_ALARM_OF_SIDE, 2) else None


def _sd(of: tuple[float, float], length: float) -> float:
    """Return the root of the sum of squares of `of[0]` [px] and `of[1]` times a length [px]."""
    return float(np.hypot(of[0], of[1] * length))


def _length(side: Array) -> float:
    """Return the distance between the ends of a side [px]."""
    return float(np.linalg.norm(side[-1] - side[0]))


def _side_errors(length: float) -> Array:
    """Compute the covariance (2, 2) at a side's ends by its own offset and tilt [px²]."""
    offset, tilt = _sd(OFFSET_SD, length) ** 2, _sd(TILT_SD, length) ** 2
    return np.array([[offset + tilt, offset - tilt], [offset - tilt, offset + tilt]])


def _side(clicked: AnnotatedPose, k: int) -> Array:
    """Project a side of the top, from corner k to the next, shape (points, 2) [px]."""
    first, last = clicked.corners_body[k], clicked.corners_body[(k + 1) % 4]
    along = first + np.linspace(0.0, 1.0, 201)[:, None] * (last - first)
    return project(clicked.camera, clicked.view, body_to_floor(along, clicked.pose.state))


def _outwards(side: Array, middle: Array) -> Array:
    """Compute the unit normals of a side that point away from the middle, shape (points, 2)."""
    along = np.gradient(side, axis=0)
    normal = np.column_stack((along[:, 1], -along[:, 0]))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return normal if np.sum(normal * (side - middle)) > 0 else -normal


def _measurement(
    outline: list[Array], middle: Array, edges: dict[int, _Edge]
) -> tuple[Array, Array]:
    """Return the derivative of the offsets of m edges by the corners, and their covariance.

    The derivative has the shape (2m, 8), two offsets for each edge; the covariance (2m, 2m) is that
    of the edges' errors, those in common of opposite sides included.
    """
    by_corner, common = np.zeros((2 * len(edges), 8)), np.zeros((2 * len(edges), 2))
    noise = np.zeros((2 * len(edges), 2 * len(edges)))
    for row, (k, edge) in enumerate(edges.items()):
        normal = _outwards(outline[k], middle)
        for place, (corner, at) in enumerate(((k, 0), ((k + 1) % 4, -1))):
            by_corner[2 * row + place, 2 * corner : 2 * corner + 2] = normal[at]
        own = slice(2 * row, 2 * row + 2)
        noise[own, own] = edge.covariance
        # Opposite sides share an error, by the extent of the plate from one to the other.
        common[own, k % 2] = _sd(OUTLINE_SD, _length(outline[(k + 1) % 4]))
    return by_corner, noise + common @ common.T


def _find_edge(pixels: NDArray[np.uint8], side: Array, normal: Array, reach: float) -> _Edge | None:
    """Find the one clear edge along a side; None where there is none, or more than one.

    None also where one end of the edge is farther than `reach` from the side.

    The strongest step of the side's mean profile gives a first offset and the edge's colours; then
    a line is fitted to the steps of segments along the side.

    Args:
        pixels: The photograph, BGR, shape (height, width, 3).
        side: Points along the side of the outline, shape (points, 2) [px].
        normal: Unit normals there, outwards, shape (points, 2).
        reach: Largest distance of the edge from the side [px].
    """
    inner = slice(round(_ENDS * len(side)), len(side) - round(_ENDS * len(side)))
    at, along = side[inner], np.linspace(-1.0, 1.0, len(side))[inner]
    unit = max(1.0, _length(side) / _UNIT)
    across, reach = unit * normal[inner], reach / unit
    # First the side as a whole, shifted; then shifted and tilted along the line found.
    first = _strongest(_profiles(pixels, at, across, reach).mean(axis=0))
    if first is None:
        return None
    line, spread = np.array([first[0], 0.0]), np.zeros((2, 2))
    for near in _NEAR:
        moved = at + (line[0] + line[1] * along)[:, None] * across
        seen = _profiles(pixels, moved, across, min(near, reach)) @ first[1]
        followed = _follow(seen, along)
        if followed is None:
            return None
        line, spread = line + followed[0], followed[1]
    if abs(line[0]) + abs(line[1]) > reach:
        return None
    ends = unit * np.array([[1.0, -1.0], [1.0, 1.0]])
    return _Edge(ends @ line, ends @ spread @ ends.T + _side_errors(_length(side)))


def _profiles(pixels: NDArray[np.uint8], at: Array, across: Array, reach: float) -> Array:
    """Interpolate the slope of the colours across a side, shape (points, distances, 3).

    Colours beyond the picture are those at its border: there is no edge.
    """
    extra = int(np.ceil(3 * _BLUR / _STEP))
    steps = int(np.ceil(reach / _STEP)) + extra
    distances = _STEP * np.arange(-steps, steps + 1)
    places = at[:, None, :] + distances[:, None] * across[:, None, :]
    height, width = pixels.shape[:2]
    values = sample(pixels, np.clip(places, 0, [width - 1, height - 1])).astype(float)
    found = gaussian_filter1d(values, _BLUR / _STEP, axis=1, order=1) / _STEP
    return found[:, extra:-extra]


def _distances(count: int) -> Array:
    """Return the distances of a profile's samples from its middle, `_STEP` apart."""
    return _STEP * (np.arange(count) - (count - 1) / 2)


def _strongest(slope: Array) -> tuple[float, Array] | None:
    """Find the strongest step of a mean profile of slopes (distances, 3).

    Returns:
        Its distance and its unit direction among the colours, (3,); None where it is at the
        border, weak, or another one is half as steep.
    """
    strength = np.linalg.norm(slope, axis=1)
    distances = _distances(len(strength))
    peak = int(strength.argmax())
    if not 0 < peak < len(strength) - 1 or strength[peak] < _CLEAR:
        return None
    inside = strength[1:-1]
    tops = 1 + np.flatnonzero((inside >= strength[:-2]) & (inside >= strength[2:]))
    others = tops[np.abs(distances[tops] - distances[peak]) > _APART]
    if len(others) and strength[others].max() > _AMBIGUOUS * strength[peak]:
        return None
    return _vertex(strength, peak), slope[peak] / strength[peak]


def _vertex(values: Array, peak: int) -> float:
    """Return the distance of the vertex of a parabola through a peak and its neighbours."""
    before, top, after = values[peak - 1 : peak + 2]
    bend = before - 2 * top + after
    shift = 0.5 * (before - after) / bend if bend < 0 else 0.0
    return float(_distances(len(values))[peak] + _STEP * np.clip(shift, -0.5, 0.5))


def _follow(slope: Array, along: Array) -> tuple[Array, Array] | None:
    """Fit a line to the strongest steps of segments of a side.

    Args:
        slope: Slopes of one colour across the side, shape (points, distances).
        along: Place of the points along the side, -1 to 1, shape (points,).

    Returns:
        Offset and tilt of the line and their covariance, (2, 2); None where less than 70 % of
        the segments lie on one line.
    """
    parts = np.array_split(np.arange(len(along)), _SEGMENTS)
    found, places = [], []
    for part in parts:
        mean = slope[part].mean(axis=0)
        peak = int(mean.argmax())
        if 0 < peak < len(mean) - 1:
            found.append(_vertex(mean, peak))
            places.append(along[part].mean())
    if len(found) < _FOLLOWED * _SEGMENTS:
        return None
    values, design = np.array(found), np.column_stack((np.ones(len(places)), places))
    used, line, off = np.ones(len(values), dtype=bool), np.zeros(2), np.zeros(len(values))
    for _ in range(5):
        line = np.linalg.lstsq(design[used], values[used], rcond=None)[0]
        off = np.abs(values - design @ line)
        used = off <= max(3 * 1.4826 * float(np.median(off)), 0.1)
    if used.sum() < _FOLLOWED * _SEGMENTS:
        return None
    variance = float(np.sum(off[used] ** 2)) / (used.sum() - 2)
    return line, variance * np.linalg.inv(design[used].T @ design[used])
