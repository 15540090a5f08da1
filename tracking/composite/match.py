# SPDX-License-Identifier: MIT
"""Match the robot's template at all headings with a rectified photograph.

In a merged picture, overlapping exposures look different from the robot alone: half of each is
hidden, or all are mixed. The correlation that remains is small. It is lost unless the heading is
right to a few degrees and the position to a fraction of the marker's cells. Both steps are
therefore finer here than in the search for a single robot (`tracking.body.search`).
"""

from collections.abc import Iterator
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from tracking.body.search import turned_template
from tracking.body.template import BodyTemplate
from tracking.camera.lens import Array
from tracking.composite.plane import Plane

TURNS = 48
"""Number of headings that are tried, 7.5 degrees apart."""

CELLS = 22
"""Points of the raster along the template's plate."""

_PEAK_CELLS = 3


class Match(NamedTuple):
    """A place where the photograph correlates with the robot's template.

    Attributes:
        score: Correlation with its picture [-].
        planar: x, y [m] and yaw [rad], shape (3,).
    """

    score: float
    planar: Array


def match_whole(
    picture: NDArray[np.float32], plane: Plane, *, template: BodyTemplate, least: float
) -> list[Match]:
    """Find local maxima of the normalised cross-correlation with the whole template.

    Args:
        picture: The photograph on `plane`, shape (rows, columns, 3); (rows, columns, 1) where the
            template is grey.
        plane: The raster.
        template: Template of the robot.
        least: Least correlation [-].

    Returns:
        Local maxima over heading and position, best first.
    """
    best, turn = None, None
    for index, (turned, mask) in _turns(template, plane.cell):
        if (np.array(picture.shape[:2]) < turned.shape[:2]).any():
            return []
        own, used = (np.ascontiguousarray(part[..., : picture.shape[2]]) for part in (turned, mask))
        score = cv2.matchTemplate(picture, own, cv2.TM_CCOEFF_NORMED, mask=used)
        score = np.where(np.isfinite(score) & (score <= 1.0001), score, -1.0).astype(np.float32)
        if best is None or turn is None:
            best, turn = np.full_like(score, -1.0), np.zeros(score.shape, int)
        better = score > best
        best[better], turn[better] = score[better], index
    if best is None or turn is None:
        return []
    return _peaks(best, turn, plane, template, least)


def _turns(template: BodyTemplate, cell: float) -> Iterator[tuple[int, tuple[NDArray, NDArray]]]:
    for index in range(TURNS):
        yield index, turned_template(template, cell, _yaw(index))


def _turned_size(template: BodyTemplate, cell: float) -> int:
    return turned_template(template, cell, 0.0)[0].shape[0]


def _yaw(index: int) -> float:
    return index * 2 * np.pi / TURNS


def _peaks(
    best: NDArray[np.float32], turn: NDArray, plane: Plane, template: BodyTemplate, least: float
) -> list[Match]:
    around = np.ones((2 * _PEAK_CELLS + 1,) * 2, np.uint8)
    rows, columns = np.nonzero((best >= cv2.dilate(best, around)) & (best >= least))
    rear, front, right, left = template.plate.extent
    middle = np.array([(front + rear) / 2, (left + right) / 2])
    half = (_turned_size(template, plane.cell) - 1) / 2
    found = []
    for row, column in zip(rows, columns, strict=True):
        yaw = _yaw(int(turn[row, column]))
        c, s = np.cos(yaw), np.sin(yaw)
        offset = np.array([c * middle[0] - s * middle[1], s * middle[0] + c * middle[1]])
        xy = plane.xy_at(row + half, column + half) - offset
        found.append(Match(float(best[row, column]), np.array([*xy, yaw])))
    return sorted(found, key=lambda match: -match.score)
