# SPDX-License-Identifier: MIT
"""A robot is tracked by its marker; where that is nowhere, other markers are named."""

from dataclasses import replace

import numpy as np
import pytest

from tracking.corrections import Move
from tracking.errors import NoUsablePhoto
from tracking.photos.by_marker import track_by_marker
from tracking.photos.workers import NoProgress

TIMES = {"p0.png": (0.0, 0.0), "p1.png": (2.0, 0.0)}


def tracked(scene, robot, photos):
    return track_by_marker(
        scene, robot, photos[:2], times=TIMES, gap=None, workers=1, progress=NoProgress()
    )


def test_the_marker_gives_the_path(scene, robot, photos, walk):
    found = tracked(scene, robot, photos)
    np.testing.assert_allclose(found.track.poses, walk[:2], atol=2e-3)


def test_a_marker_that_is_nowhere_is_said_with_those_that_are(scene, robot, photos):
    other = replace(robot, marker=replace(robot.marker, marker_id=7))
    with pytest.raises(NoUsablePhoto, match=r"marker 7 .*p0\.png shows 0 of '4x4_50'"):
        tracked(scene, other, photos)
    placed = replace(scene, corrections=(Move("p0.png", 0.5, 0.2, 0.1),))
    found = tracked(placed, other, photos)
    assert list(found.lost) == ["p1.png"]
    np.testing.assert_allclose(found.track.poses, [[0.5, 0.2, 0.1]])
