# SPDX-License-Identifier: MIT
"""Find the robot's template in a photograph: rectify, match at all headings, align.

The photograph is rectified, coarsely, onto the level plane of the robot's top, where the robot has
the same size everywhere. The template is rotated in steps and matched by normalised
cross-correlation. The best places are aligned.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from tracking.body.align import Alignment, align
from tracking.body.plane import Plane
from tracking.body.template import BodyTemplate
from tracking.camera.lens import Camera, CameraPose, to_floor
from tracking.errors import FloorError
from tracking.pose import BodyPrior

ACCEPTED_SCORE = 0.7
"""Least correlation of an alignment to accept it as the robot [-]."""

LEAST_MATCH = 0.3
"""Least correlation of a coarse match to align it [-]."""

_TURNS = 24  # headings of `match_turned`
_PEAK_CELLS = 3  # half the width in which a peak of `match_whole` is the highest
_CELLS = 14  # pixels of the rectified photograph along the plate


@dataclass(frozen=True)
class BodyCandidates:
    """Candidate alignments at one place in a photograph, which differ in heading.

    Attributes:
        options: Alignments at one place that differ in heading, the likeliest first; a robot about
            as wide as long has up to four.
    """

    options: tuple[Alignment, ...]

    @property
    def best(self) -> Alignment:
        """The alignment of greatest likelihood, first in `options`."""
        return self.options[0]

    @property
    def evidence(self) -> Array:
        """Log likelihood of each option minus that of the best, shape (options,), at most 0."""
        likelihood = np.array([option.log_likelihood for option in self.options])
        return likelihood - likelihood[0]


def find_body(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, template: BodyTemplate,
    prior: BodyPrior, near: ArrayLike | None = None, reach: float = 0.5,
    visible: NDArray[np.bool_] | None = None,
) -> BodyCandidates | None:  # fmt: skip
    """Find the robot in a photograph by its template.

    Args:
        pixels: The photograph, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        template: Template of the robot.
        prior: Prior of the body's height and tilt.
        near: x and y of the middle of the square to search [m]; None for the whole photograph (as
            far as three camera heights).
        reach: Half the side of that square [m].
        visible: True at pixels that may show the robot, shape (height, width); None for all.

    Returns:
        The alignment of highest score, and those of the opposite heading there, and of both across
        it if the plate is about as wide as long, where `align` gives one, likeliest first; None
        where no alignment reaches `ACCEPTED_SCORE`.

    Raises:
        FloorError: When the photograph shows nothing of the top's plane (see `floor_in_view`).
    """
    height = prior.height + template.plate.height
    area = floor_in_view(camera, view, height, near, reach)
    starts = match_turned(pixels, camera, view, template=template, height=height, area=area)
    found = []
    for start in starts:
        alignment = align(
            pixels, camera, view, template=template, prior=prior, start=start, visible=visible
        )
        if alignment is not None and alignment.score >= ACCEPTED_SCORE:
            found.append(alignment)
    if not found:
        return None
    best = max(found, key=lambda alignment: alignment.score)
    return BodyCandidates(_all_headings(best, pixels, camera, view, template, prior, visible))


def _all_headings(
    best: Alignment, pixels: NDArray[np.uint8], camera: Camera, view: CameraPose,
    template: BodyTemplate, prior: BodyPrior, visible: NDArray[np.bool_] | None,
) -> tuple[Alignment, ...]:  # fmt: skip
    """Align from the opposite heading, too, and from those across it for a square plate.

    Returns alignments that differ by over 45 degrees from each other, the likeliest first.
    """
    plate = template.plate
    square = abs(plate.length - plate.width) < 0.2 * max(plate.length, plate.width)
    options = [best]
    for turn in (0.5 * np.pi, np.pi, 1.5 * np.pi) if square else (np.pi,):
        start = _turned_about_plate(best.pose.planar, (plate.centre_x, plate.centre_y), turn)
        other = align(
            pixels, camera, view, template=template, prior=prior, start=start, visible=visible
        )
        if other is not None and all(_differ(other, option) for option in options):
            options.append(other)
    return tuple(sorted(options, key=lambda option: -option.log_likelihood))


def _differ(a: Alignment, b: Alignment) -> bool:
    """Return whether the headings of two alignments differ by over 45 degrees."""
    return bool(np.cos(a.pose.state[5] - b.pose.state[5]) < 0.7)


def _turned_about_plate(planar: Array, centre: tuple[float, float], turn: float) -> Array:
    """Turn x, y, yaw of the body by an angle about the plate's centre, given in its frame."""
    x, y, yaw = planar
    c, s = np.cos([yaw, yaw + turn]), np.sin([yaw, yaw + turn])
    shift = np.column_stack((c * centre[0] - s * centre[1], s * centre[0] + c * centre[1]))
    return np.array([*(np.array([x, y]) + shift[0] - shift[1]), yaw + turn])


def floor_in_view(
    camera: Camera, view: CameraPose, height: float,
    near: ArrayLike | None = None, reach: float = np.inf,
) -> tuple[Array, Array]:  # fmt: skip
    """Compute the bounding rectangle of the part of a level plane that the camera sees.

    Args:
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        height: Height of the plane over the floor [m].
        near: x and y of the middle of a square that limits the rectangle; None for no limit [m].
        reach: Half the side of that square [m].

    Returns:
        Lowest and highest x, y, each of shape (2,) [m], of the plane within three camera heights
        of the camera; the lowest may exceed the highest if the square lies outside.

    Raises:
        FloorError: The camera sees no such point: it is mounted too low, or not tilted down.
    """
    width, rows = camera.size
    edge = np.array(
        [[u, v] for u in np.linspace(0, width - 1, 9) for v in np.linspace(0, rows - 1, 9)]
    )
    seen = to_floor(camera, view, edge, height)
    # Floor near the horizon would make the raster unbounded and shows no robot.
    reached = 3 * view.position[2]
    seen = seen[np.linalg.norm(seen - view.position[:2], axis=1) < reached]
    if not len(seen):
        raise FloorError(
            f"the camera, {view.position[2]:.2f} m high, sees no place at the height of the "
            f"robot's top ({height:.2f} m) within {reached:.2f} m (three times its own height), "
            "where the robot is searched; mount the camera higher or tilt it down"
        )
    low, high = seen.min(axis=0), seen.max(axis=0)
    if near is not None:
        middle = np.asarray(near, dtype=float)[:2]
        low, high = np.maximum(low, middle - reach), np.minimum(high, middle + reach)
    return low, high


def match_turned(
    pixels: NDArray[np.uint8], camera: Camera, view: CameraPose, *, template: BodyTemplate,
    height: float, area: tuple[Array, Array], most: int = 4,
) -> list[Array]:  # fmt: skip
    """Match the template at a set of headings on the rectified photograph.

    Args:
        pixels: The photograph, BGR, shape (height, width, 3).
        camera: Camera intrinsics and distortion.
        view: Pose of the camera.
        template: Template of the robot.
        height: Height of the robot's top over the floor [m].
        area: Lowest and highest x, y to search, each of shape (2,) [m].
        most: Largest number of poses to return.

    Returns:
        x, y [m] and yaw [rad] of the robot, shape (3,) each, at matches of at least `LEAST_MATCH`
        that differ in place or heading, best first; empty if there are none.
    """
    cell = template.plate.length / _CELLS
    rear, front, right, left = template.plate.extent
    half = 0.5 * np.hypot(front - rear, left - right)
    low, high = area[0] - half, area[1] + half
    plane = Plane.over(camera, view, height=height, low=low, high=high, cell=cell)
    peaks: list[tuple[float, Array]] = []
    per_turn = max(2, most // 2)
    for yaw, match in correlations(plane.read_smooth(pixels), template, cell, turns=_TURNS):
        for _ in range(per_turn):
            row, column = np.unravel_index(np.argmax(match), match.shape)
            if match[row, column] < LEAST_MATCH:
                break
            planar = pose_of_match(template, plane, int(row), int(column), yaw)
            peaks.append((float(match[row, column]), planar))
            # The next peak lies elsewhere: at least half a plate away in x or y.
            match[max(row - 6, 0) : row + 7, max(column - 6, 0) : column + 7] = -1.0
    return _apart(peaks, most, template.plate.length)


def match_whole(
    picture: NDArray[np.float32], plane: Plane, *, template: BodyTemplate, least: float
) -> list[Array]:
    """Find local maxima of the normalised cross-correlation with the whole template.

    Of overlapping exposures half of each is hidden. The correlation that remains is lost unless the
    heading is right to a few degrees: headings are twice as many as in `match_turned`.

    Args:
        picture: The photograph on the plane, shape (rows, columns, channels).
        plane: The plane of the robot's top.
        template: The template, of which are used as many channels as the picture has.
        least: Least correlation of a match [-].

    Returns:
        x, y [m] and yaw [rad] of the matches, the best first, shape (3,) each; empty without any.
    """
    best = yaws = None
    for yaw, score in correlations(picture, template, plane.cell, turns=2 * _TURNS):
        if best is None or yaws is None:
            best, yaws = np.full_like(score, -1.0), np.zeros(score.shape)
        better = score > best
        best[better], yaws[better] = score[better], yaw
    if best is None or yaws is None:
        return []
    around = np.ones((2 * _PEAK_CELLS + 1,) * 2, np.uint8)
    peaks = np.argwhere((best >= cv2.dilate(best, around)) & (best >= least)).tolist()
    return [
        pose_of_match(template, plane, row, column, float(yaws[row, column]))
        for row, column in sorted(peaks, key=lambda peak: -best[peak[0], peak[1]])
    ]


def correlations(
    picture: NDArray[np.float32], template: BodyTemplate, cell: float, *, turns: int
) -> Iterator[tuple[float, NDArray[np.float32]]]:
    """Yield the normalised cross-correlation with the template at every heading.

    Args:
        picture: The rectified photograph, shape (rows, columns, channels).
        template: Template of the robot; as many of its channels as the picture has are compared.
        cell: Size of a pixel of the rectified photograph [m].
        turns: Number of headings.

    Yields:
        Heading, from 0 up [rad], and correlations by row and column of the rotated template's first
        pixel, shape (m, n), -1 where undefined [-]; nothing where the picture is smaller than it.
    """
    for yaw in np.arange(turns) * 2 * np.pi / turns:
        turned, mask = (
            np.ascontiguousarray(part[..., : picture.shape[2]])
            for part in turned_template(template, cell, yaw)
        )
        if (np.array(picture.shape[:2]) < turned.shape[:2]).any():
            return
        match = cv2.matchTemplate(picture, turned, cv2.TM_CCOEFF_NORMED, mask=mask)
        yield yaw, np.where(np.isfinite(match) & (match <= 1.0001), match, np.float32(-1.0))


def pose_of_match(template: BodyTemplate, plane: Plane, row: int, column: int, yaw: float) -> Array:
    """Compute the robot's pose from row and column of a template match at a heading.

    Args:
        template: Template of the robot.
        plane: Raster of the rectified photograph.
        row: Row in the correlations (see `correlations`).
        column: Column in the correlations.
        yaw: Heading of the template [rad].

    Returns:
        x, y [m] and yaw [rad] of the body's origin, shape (3,).
    """
    rear, front, right, left = template.plate.extent
    ahead, aside = (front + rear) / 2, (left + right) / 2
    c, s = np.cos(yaw), np.sin(yaw)
    offset = np.array([c * ahead - s * aside, s * ahead + c * aside])
    half = (turned_template(template, plane.cell, 0.0)[0].shape[0] - 1) / 2
    return np.array([*(plane.xy_at(row + half, column + half) - offset), yaw])


def _apart(peaks: list[tuple[float, Array]], most: int, length: float) -> list[Array]:
    """Keep the best of peaks alike in place and heading (non-maximum suppression), at most `most`.

    Alike are those within 0.15 of the robot's `length` and 37 degrees.
    """
    kept: list[Array] = []
    for _, peak in sorted(peaks, key=lambda pair: -pair[0]):
        near = [np.hypot(*(peak[:2] - other[:2])) < 0.15 * length for other in kept]
        turned = [np.cos(peak[2] - other[2]) > 0.8 for other in kept]
        if not any(a and b for a, b in zip(near, turned, strict=True)):
            kept.append(peak)
        if len(kept) == most:
            break
    return kept


def turned_template(
    template: BodyTemplate, cell: float, yaw: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Draw the template rotated to a heading, as seen from above.

    Args:
        template: Template of the robot, its front up.
        cell: Size of a pixel [m].
        yaw: Heading, 0 to the right, counter-clockwise [rad].

    Returns:
        Colours, shape (n, n, 3), centred on the template's middle, and a mask of the same shape, 1
        on the template, else 0; n is the same for all headings.
    """
    small = _shrunk(template, cell)
    rows, columns = small.shape[:2]
    n = int(np.ceil(np.hypot(rows, columns))) + 1
    matrix = cv2.getRotationMatrix2D(((columns - 1) / 2, (rows - 1) / 2), np.degrees(yaw) - 90, 1.0)
    matrix[:, 2] += np.array([(n - columns) / 2, (n - rows) / 2])
    picture = cv2.warpAffine(small, matrix, (n, n), flags=cv2.INTER_LINEAR)
    mask = cv2.warpAffine(np.ones((rows, columns), np.float32), matrix, (n, n))
    mask = np.where(mask > 0.9, 1.0, 0.0).astype(np.float32)
    return np.asarray(picture, dtype=np.float32), np.repeat(mask[:, :, None], 3, axis=2)


def _shrunk(template: BodyTemplate, cell: float) -> NDArray[np.float32]:
    """Scale the template's colours to pixels of side `cell` [m], at least 4 in each direction."""
    ratio = template.step / cell
    size = [max(4, round(n * ratio)) for n in template.colours.shape[1::-1]]
    small = cv2.resize(template.colours, size, interpolation=cv2.INTER_AREA)
    return np.asarray(small, dtype=np.float32)
