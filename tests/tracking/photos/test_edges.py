# SPDX-License-Identifier: MIT
"""A walk whose marker changes size from photograph to photograph has edges that scatter."""

import numpy as np

from benchmarks.accuracy.drawn_walks.world import PLAIN, Spreads, draw_walk
from benchmarks.accuracy.tracked_walks import photographed
from tracking.photos.edges import edge_spread
from tracking.photos.result import shared_errors


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


def test_a_walk_to_and_fro_raises_the_spread_and_a_steady_one_does_not_lower_it():
    steady = [spreads(0.0, seed) for seed in range(3)]
    assert all(walk >= 0.99 * floor for floor, walk in steady)
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
