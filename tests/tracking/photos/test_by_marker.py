# SPDX-License-Identifier: MIT
"""A robot is tracked by its marker; where that is nowhere, other markers are named."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_tracks import photographed
from support.drawn_walks import PLAIN, Spreads, draw_walk
from tracking.corrections import Delete, Move
from tracking.errors import NoUsablePhoto, PathError
from tracking.photos.by_marker import edge_spread, track_by_marker
from tracking.photos.result import shared_errors
from tracking.photos.workers import NoProgress

TIMES = {"p0.png": (0.0, 0.0), "p1.png": (2.0, 0.0)}


def tracked(scene, robot, photos):
    return track_by_marker(
        scene, robot, photos[:2], times=TIMES, gap=None, workers=1, progress=NoProgress()
    )


def test_a_marker_that_is_nowhere_is_said_with_those_that_are(scene, robot, photos):
    other = replace(robot, marker=replace(robot.marker, marker_id=7))
    with pytest.raises(NoUsablePhoto, match=r"marker 7 .*p0\.png shows 0 of '4x4_50'"):
        tracked(scene, other, photos)
    placed = replace(scene, corrections=(Move("p0.png", 0.5, 0.2, 0.1),))
    found = tracked(placed, other, photos)
    assert list(found.lost) == ["p1.png"]
    np.testing.assert_allclose(found.track.poses, [[0.5, 0.2, 0.1]])


def spreads(edges: float, seed: int) -> tuple[float, float]:
    """Return the spread of edges by the floor's markers, and by the walk too."""
    walk = draw_walk(
        np.random.default_rng(seed), lens=PLAIN, distance=3.4, spreads=Spreads(edges=edges)
    )
    scene, seen, times = photographed(walk)
    assert scene.robot is not None
    found = edge_spread(
        seen.fit, seen.detections, robot=scene.robot, times=times,
        shared=shared_errors(scene, seen), gap=None,
    )  # fmt: skip
    return seen.fit.edge_spread.sd, found.sd


@pytest.mark.long
def test_a_walk_to_and_fro_raises_the_spread_and_a_steady_one_does_not_lower_it():
    steady = [spreads(0.0, seed) for seed in range(3)]
    assert all(walk >= 0.999999 * floor for floor, walk in steady)
    rough = [spreads(0.3, seed)[1] for seed in range(3)]
    assert np.mean(rough) > 2 * np.mean([walk for _, walk in steady])


def test_a_few_photographs_say_nothing():
    walk = draw_walk(np.random.default_rng(0), lens=PLAIN, distance=3.4, spreads=Spreads())
    scene, seen, times = photographed(walk)
    assert scene.robot is not None
    found = edge_spread(
        seen.fit, seen.detections[:2], robot=scene.robot, times=times,
        shared=shared_errors(scene, seen), gap=None,
    )  # fmt: skip
    assert found is seen.fit.edge_spread


def test_a_second_photograph_of_one_time_may_be_deleted_by_a_correction():
    walk = draw_walk(np.random.default_rng(0), lens=PLAIN, distance=3.4, spreads=Spreads())
    scene, seen, times = photographed(walk)
    assert scene.robot is not None
    names = [each.photo for each in seen.detections if each.robot is not None]
    twice = {**times, names[1]: times[names[0]]}
    given = {"robot": scene.robot, "times": twice, "shared": shared_errors(scene, seen),
             "gap": None}  # fmt: skip
    with pytest.raises(PathError, match="times must increase"):
        edge_spread(seen.fit, seen.detections, **given)
    mended = edge_spread(seen.fit, seen.detections, corrections=[Delete(names[1])], **given)
    without = [each for each in seen.detections if each.photo != names[1]]
    assert mended.sd == edge_spread(seen.fit, without, **{**given, "times": times}).sd


def test_a_pose_set_by_hand_is_followed():
    walk = draw_walk(np.random.default_rng(0), lens=PLAIN, distance=3.4, spreads=Spreads())
    scene, seen, times = photographed(walk)
    assert scene.robot is not None
    names = [each.photo for each in seen.detections if each.robot is not None]
    given = {"robot": scene.robot, "shared": shared_errors(scene, seen), "gap": None}
    right = edge_spread(seen.fit, seen.detections, times=times, **given)
    move = Move(names[2], 5.0, 5.0, 0.0)  # far away: were it used, the walk would be in pieces
    moved = edge_spread(seen.fit, seen.detections, times=times, corrections=[move], **given)
    assert moved.sd == pytest.approx(right.sd, rel=0.5)
