# SPDX-License-Identifier: MIT
"""Detect markers: OpenCV's detector first, template matching of its rejected candidates second.

OpenCV decodes bit by bit and rejects markers that are dark or blurred, although their outline is
among its candidate quadrilaterals. Those are correlated with the marker that is wanted: one known
picture of 36 cells is recognised long after its bits cannot be decoded.
"""

from collections.abc import Iterable, Sequence
from functools import cache
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.arrays import Array
from tracking.markers.apriltags import apriltag_quads
from tracking.markers.dictionaries import dictionary_named, marker_family
from tracking.markers.refine import Sighting, refine_corners
from tracking.markers.square import marker_picture

ACCEPTED_SCORE = 0.8
"""Least correlation to accept a marker that OpenCV did not decode [-]."""

LEAST_SCORE = 0.5
"""Least correlation to accept a marker that OpenCV decoded [-]."""

_DARK_COUNTS = 128  # from black to white: fewer make a dark picture


class Region(NamedTuple):
    """A window of the picture, in whole pixels: left, top, right and bottom (excluded) [px]."""

    left: int
    top: int
    right: int
    bottom: int


def neighbourhood(corners_px: ArrayLike, size: tuple[int, int], *, reach: float) -> Region:
    """Compute the search window around the previous place of a marker or robot.

    Args:
        corners_px: Points of the marker or robot at its previous place, shape (n, 2) [px].
        size: Width and height of the picture [px].
        reach: Distance added on each side, by which the marker or robot may have moved [px].

    Returns:
        The window, clipped to the picture.
    """
    corners = np.asarray(corners_px, dtype=float)
    low = np.clip(np.floor(corners.min(axis=0) - reach), 0, size).astype(int)
    high = np.clip(np.ceil(corners.max(axis=0) + reach) + 1, 0, size).astype(int)
    return Region(int(low[0]), int(low[1]), int(high[0]), int(high[1]))


def find_markers(
    pixels: NDArray[np.uint8],
    dictionary: str,
    *,
    wanted: Iterable[int],
    region: Region | None = None,
    effort: int = 2,
    several: bool = False,
) -> tuple[Sighting, ...]:
    """Detect the wanted markers in a picture.

    Args:
        pixels: The picture, grey or BGR, shape (height, width) or (height, width, 3).
        dictionary: Name of the markers' dictionary.
        wanted: Numbers of the markers to detect; others are ignored.
        region: Window to search; None for the whole picture.
        effort: 0: OpenCV's detector alone, corners to about a pixel, score 1. 1: corners refined;
            missing markers also by pupil-apriltags and among quadrilaterals that OpenCV rejected.
            2: markers still missing also in a brightened picture (if it is dark) and in an
            enlarged picture with equalised contrast.
        several: Whether the picture may show several markers of one number, which are then all
            sought with the whole effort; otherwise further ones are found only by chance.

    Returns:
        Markers detected, ordered by number, in pixels of the whole picture. A number occurs twice
        if the marker is detected twice. Empty where a side of the window is below 16 px.

    Raises:
        MarkerError: When there is no such dictionary.
    """
    area = Region(0, 0, pixels.shape[1], pixels.shape[0]) if region is None else region
    grey = _grey(pixels[area.top : area.bottom, area.left : area.right])
    if min(grey.shape) < 16:
        return ()
    numbers = sorted(set(wanted))
    if effort == 0:
        return tuple(_moved(s, (area.left, area.top)) for s in _plain(grey, dictionary, numbers))
    is_in_opencv = marker_family(dictionary).is_in_opencv
    found = (_with_opencv if is_in_opencv else _as_tags)(grey, dictionary, numbers, several)
    again = (_brightened, _enlarged) if is_in_opencv else (_as_enlarged_tags,)
    for seek in again if effort > 1 else ():
        missing = _missing(numbers, found, several)
        if missing:
            found += seek(grey, dictionary, missing)
    if several:
        found = _apart(found)
    moved = (_moved(sighting, (area.left, area.top)) for sighting in found)
    return tuple(sorted(moved, key=lambda sighting: sighting.marker_id))


def _grey(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return a picture as grey levels and contiguous in memory."""
    if pixels.ndim == 3:
        return np.asarray(cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY), dtype=np.uint8)
    return np.ascontiguousarray(pixels)


def _detector(dictionary: str, *, patient: bool) -> cv2.aruco.ArucoDetector:
    """Return OpenCV's detector; a `patient` one seeks fainter and more distorted outlines."""
    parameters = cv2.aruco.DetectorParameters()
    if patient:
        parameters.adaptiveThreshConstant = 3.0
        parameters.adaptiveThreshWinSizeMax = 53
        parameters.polygonalApproxAccuracyRate = 0.08
        # Of outlines nearer to each other than this share of their length OpenCV keeps one: of a
        # marker, its paper and the plate below it sometimes the wrong one.
        parameters.minMarkerDistanceRate = 0.03
    return cv2.aruco.ArucoDetector(dictionary_named(dictionary), parameters)


def _with_opencv(
    grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int], several: bool
) -> list[Sighting]:
    """Detect by OpenCV, what is missing by pupil-apriltags, then among OpenCV's rejected quads."""
    corners, ids, others = _detector(dictionary, patient=False).detectMarkers(grey)
    found = _fitted(grey, _decoded(corners, ids, numbers), dictionary, LEAST_SCORE)
    missing = _missing(numbers, found, several)
    if missing:
        quads = apriltag_quads(grey, dictionary, missing)
        found += _fitted(grey, quads, dictionary, ACCEPTED_SCORE)
        missing = _missing(numbers, found, several)
    return found + recognise(grey, others, dictionary, missing) if missing else found


def _as_tags(
    grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int], _: bool = False
) -> list[Sighting]:
    """Detect tags that OpenCV does not have; each is decoded, so that its score may be low."""
    return _fitted(grey, apriltag_quads(grey, dictionary, numbers), dictionary, LEAST_SCORE)


def _as_enlarged_tags(
    grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int]
) -> list[Sighting]:
    """Detect as `_as_tags` in a picture twice as large; refine in the original."""
    quads = apriltag_quads(_twice_as_large(grey), dictionary, numbers)
    small = [(_in_small(corners), number) for corners, number in quads]
    return _fitted(grey, small, dictionary, LEAST_SCORE)


def _fitted(
    grey: NDArray[np.uint8], quads: Iterable[tuple[Array, int]], dictionary: str, least: float
) -> list[Sighting]:
    """Refine the corners of quadrilaterals of known number; keep scores of at least `least`."""
    sightings = (
        refine_corners(grey, quad, dictionary=dictionary, marker_id=number)
        for quad, number in quads
    )
    return [each for each in sightings if each is not None and each.score >= least]


def _missing(numbers: Iterable[int], found: Iterable[Sighting], several: bool = False) -> list[int]:
    """Return the numbers that are not found; all of them if there may be several of each."""
    if several:
        return list(numbers)
    seen = {sighting.marker_id for sighting in found}
    return [number for number in numbers if number not in seen]


def _plain(grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int]) -> list[Sighting]:
    """Detect by a detector alone, with 0.5 px as the standard deviation of each coordinate."""
    if not marker_family(dictionary).is_in_opencv:
        quads = apriltag_quads(grey, dictionary, numbers)
    else:
        corners, ids, _ = _detector(dictionary, patient=False).detectMarkers(grey)
        quads = _decoded(corners, ids, numbers)
    whole_px = 0.5**2 * np.eye(8)
    found = [Sighting(number, quad, whole_px, 1.0, 0.0) for quad, number in quads]
    return sorted(found, key=lambda sighting: sighting.marker_id)


def _decoded(
    corners: Iterable[ArrayLike], ids: ArrayLike | None, numbers: Sequence[int]
) -> list[tuple[Array, int]]:
    """Return corners (4, 2) and number of those of OpenCV's markers that are wanted."""
    pairs = zip(corners, [] if ids is None else np.ravel(ids), strict=True)
    quads = [(np.asarray(quad, dtype=float).reshape(4, 2), int(number)) for quad, number in pairs]
    return [(quad, number) for quad, number in quads if number in numbers]


def _brightened(grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int]) -> list[Sighting]:
    """Detect in a dark picture stretched to full contrast; refine in the original.

    Empty where the picture is not dark (128 grey levels or more from black to white) or uniform.
    OpenCV's threshold is 7 grey levels at any brightness.
    """
    darkest, brightest = np.percentile(grey, (0.1, 99.9))
    if not 0 < brightest - darkest < _DARK_COUNTS:
        return []
    gain = 255 / (brightest - darkest)
    bright = cv2.convertScaleAbs(np.maximum(grey, darkest) - darkest, alpha=gain)
    corners, _, others = _detector(dictionary, patient=False).detectMarkers(bright)
    return recognise(grey, (*corners, *others), dictionary, numbers)


def _enlarged(grey: NDArray[np.uint8], dictionary: str, numbers: Sequence[int]) -> list[Sighting]:
    """Recognise markers in a picture twice as large; refine in the original."""
    large = _twice_as_large(grey)
    corners, _, others = _detector(dictionary, patient=True).detectMarkers(large)
    # Corners are refined in the original pixels in either case.
    quads = [_in_small(quad) for quad in (*corners, *others)]
    return recognise(grey, quads, dictionary, numbers)


def _twice_as_large(grey: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Enlarge a picture twofold and equalise its contrast in 8 x 8 parts."""
    large = cv2.resize(grey, None, fx=2.0, fy=2.0, interpolation=cv2.INTER_CUBIC)
    large = cv2.createCLAHE(clipLimit=3.0, tileGridSize=(8, 8)).apply(large)
    return np.asarray(large, dtype=np.uint8)


def _in_small(corners_px: ArrayLike) -> Array:
    """Convert pixels of `_twice_as_large`: the middle of its pixels 2u and 2u + 1 is pixel u."""
    return (np.asarray(corners_px, dtype=float) + 0.5) / 2 - 0.5


def recognise(
    grey: NDArray[np.uint8], quads: Iterable[ArrayLike], dictionary: str, numbers: Sequence[int]
) -> list[Sighting]:
    """Classify quadrilaterals as wanted markers by correlation with the markers' pictures.

    Not considered are quadrilaterals not convex, of a side of 8 px or less, or of one below 0.2 of
    the longest.

    Args:
        grey: The picture, shape (height, width).
        quads: Corners of quadrilaterals, 8 numbers each, starting from any corner [px].
        dictionary: Name of the markers' dictionary.
        numbers: Numbers of the markers wanted.

    Returns:
        Markers of at least `ACCEPTED_SCORE` that no other of the dictionary resembles more, corners
        refined, best first; of several in one place the one of highest score.
    """
    candidates = []
    for quad in quads:
        corners = np.asarray(quad, dtype=float).reshape(4, 2)
        if not _is_marker_like(corners):
            continue
        for number in numbers:
            turned = _best_turn(grey, corners, dictionary, number)
            if turned is None:
                continue
            sighting = refine_corners(grey, turned, dictionary=dictionary, marker_id=number)
            if sighting is None or sighting.score < ACCEPTED_SCORE:
                continue
            if _number_at(grey, sighting.corners_px, dictionary) == number:
                candidates.append(sighting)
    return _apart(candidates)


def _is_marker_like(corners: Array) -> bool:
    """Return whether corners are convex, all sides over 8 px and over 0.2 of the longest."""
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=0), axis=1)
    convex = cv2.isContourConvex(corners.astype(np.float32))
    return bool(convex and sides.min() > 8 and sides.min() > 0.2 * sides.max())


def _best_turn(
    grey: NDArray[np.uint8], corners: Array, dictionary: str, number: int
) -> Array | None:
    """Roll a quadrilateral's corners for best correlation with a marker; None if it is <= 0.5."""
    target = marker_picture(dictionary, number, 4)
    inner = np.ascontiguousarray(target[4:-4, 4:-4])
    best, best_score = None, 0.5
    for turn in range(4):
        turned = np.roll(corners, turn, axis=0)
        flat = _flattened(grey, turned, inner.shape[0])
        score = float(cv2.matchTemplate(flat, inner, cv2.TM_CCOEFF_NORMED)[0, 0])
        if score > best_score:
            best, best_score = turned, score
    return best


def _flattened(grey: NDArray[np.uint8], corners: Array, n: int) -> NDArray[np.float32]:
    """Rectify the inside of a quadrilateral to n x n pixels, its first corner top left."""
    square = np.array([[0, 0], [n, 0], [n, n], [0, n]], dtype=np.float32) - np.float32(0.5)
    H = cv2.getPerspectiveTransform(corners.astype(np.float32), square)
    return cv2.warpPerspective(grey, H, (n, n), flags=cv2.INTER_AREA).astype(np.float32)


def _number_at(grey: NDArray[np.uint8], corners: Array, dictionary: str) -> int:
    """Return the number of the dictionary's marker that correlates best, in any rotation.

    Markers of one dictionary share their border and half of their cells. Where one lies, another
    that is wanted correlates by up to 0.8, and would be taken for a second robot.
    """
    pictures = _cells_of_all(dictionary)
    cells = round(pictures.shape[1] ** 0.5)
    seen = cv2.resize(
        _flattened(grey, corners, 4 * cells), (cells, cells), interpolation=cv2.INTER_AREA
    )
    return int(np.argmax(pictures @ np.ravel(seen - seen.mean()))) // 4


@cache
def _cells_of_all(dictionary: str) -> Array:
    """Return the cells of all markers, border included, with mean 0 and norm 1.

    Shape (4 n, cells): rows 4 k to 4 k + 3 are the rotations of marker k of n.
    """
    count = marker_family(dictionary).count
    inner = [marker_picture(dictionary, number, 1)[1:-1, 1:-1] for number in range(count)]
    turned = np.array([np.rot90(cells, turn).ravel() for cells in inner for turn in range(4)])
    turned -= turned.mean(axis=1, keepdims=True)
    return turned / np.linalg.norm(turned, axis=1, keepdims=True)


def _apart(candidates: list[Sighting]) -> list[Sighting]:
    """Keep of overlapping sightings the one of highest score (non-maximum suppression).

    Two overlap if the centre of one is inside the other, whatever their numbers. The result is
    ordered by score, highest first.
    """
    kept: list[Sighting] = []
    for sighting in sorted(candidates, key=lambda candidate: -candidate.score):
        if not any(_is_inside(sighting, of) or _is_inside(of, sighting) for of in kept):
            kept.append(sighting)
    return kept


def _is_inside(sighting: Sighting, other: Sighting) -> bool:
    """Return whether the centre of a marker is inside another, or on its edge."""
    outline = other.corners_px.astype(np.float32)
    x, y = sighting.corners_px.mean(axis=0).tolist()
    return cv2.pointPolygonTest(outline, (x, y), measureDist=False) >= 0


def _moved(sighting: Sighting, offset: tuple[int, int]) -> Sighting:
    """Return a sighting with an offset in column and row added to its corners [px]."""
    corners = sighting.corners_px + np.asarray(offset, dtype=float)
    return Sighting(sighting.marker_id, corners, sighting.covariance, sighting.score, sighting.blur)
