# SPDX-License-Identifier: MIT
"""Match the robot's template at all headings with a rectified photograph.

In a merged picture, overlapping exposures look different from the robot alone: half of each is
hidden, or all are mixed. The correlation that remains is small. It is lost unless the heading is
right to a few degrees and the position to a fraction of the marker's cells. Both steps are
therefore finer here than in the search for a single robot (`tracking.body.search`).
"""

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from tracking.body.plane import Plane
from tracking.body.search import correlations, pose_of_match
from tracking.body.template import BodyTemplate

TURNS = 48
"""Number of headings that are tried, 7.5 degrees apart."""

CELLS = 22
"""Number of raster points along the length of the template's plate."""

_PEAK_CELLS = 3


class Match(NamedTuple):
    """A pose at which the photograph correlates with the robot's template.

    Attributes:
        score: Normalised cross-correlation of photograph and template [-].
        planar: x, y [m] and yaw [rad] of the robot, shape (3,).
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
        plane: Raster of the rectified photograph.
        template: Template of the robot.
        least: Least correlation of a match [-].

    Returns:
        Local maxima over position, each with its best heading, best first; none where the picture
        is smaller than the template.
    """
    best = yaws = None
    for yaw, score in correlations(picture, template, plane.cell, turns=TURNS):
        if best is None or yaws is None:
            best, yaws = np.full_like(score, -1.0), np.zeros(score.shape)
        better = score > best
        best[better], yaws[better] = score[better], yaw
    if best is None or yaws is None:
        return []
    around = np.ones((2 * _PEAK_CELLS + 1,) * 2, np.uint8)
    found = []
    for row, column in np.argwhere((best >= cv2.dilate(best, around)) & (best >= least)):
        planar = pose_of_match(template, plane, int(row), int(column), float(yaws[row, column]))
        found.append(Match(float(best[row, column]), planar))
    return sorted(found, key=lambda match: -match.score)
