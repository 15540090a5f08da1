# SPDX-License-Identifier: MIT
"""Errors of tracks of simulated walks are as large as their covariances say."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from support.drawn_tracks import track_marked, track_unmarked
from support.drawn_walks import PLAIN, WIDE, Spreads, draw_walk
from tracking.floor import EDGE_SPREADS
from tracking.floor.edge_spread import EDGE_SCALE

DISTANCES = (2.0, 2.6, 3.4, 4.4, 5.7)  # m
WALKS = 40


def drawn_spread(rng):
    """Draw a spread of edges from the half-Cauchy prior within `EDGE_SPREADS` [px]."""
    low, high = np.arctan(EDGE_SPREADS[[0, -1]] / EDGE_SCALE)
    return float(EDGE_SCALE * np.tan(rng.uniform(low, high)))


def squared_errors(seed, *, lens, distance, edges, annotated):
    """Return the squared error by the covariance over its degrees of freedom: marginal, joint."""
    rng = np.random.default_rng(seed)
    spreads = replace(Spreads(), edges=edges)
    walk = draw_walk(rng, lens=lens, distance=distance, spreads=spreads)
    tracked = track_unmarked(walk, rng, annotated) if annotated else track_marked(walk)
    error = tracked.track.poses - walk.poses
    error[:, 2] = np.angle(np.exp(1j * error[:, 2]))
    inverse = np.linalg.inv(tracked.track.covariance)
    marginal = np.einsum("ni,nij,nj->n", error, inverse, error).mean() / 3
    flat = error.ravel()
    joint = flat @ np.linalg.solve(tracked.track.joint.dense, flat) / len(flat)
    return marginal, joint


@pytest.mark.long
@pytest.mark.parametrize("annotated", [0, 1, 3])
def test_errors_are_as_large_as_the_covariances_say(annotated):
    rng = np.random.default_rng(7)
    kinds = list(product((PLAIN, WIDE), DISTANCES))
    found = []
    for k in range(WALKS):
        lens, distance = kinds[k % len(kinds)]
        edges = 0.03 if annotated else drawn_spread(rng)
        found.append(
            squared_errors(1000 + k, lens=lens, distance=distance, edges=edges, annotated=annotated)
        )
    marginal, joint = np.mean(found, axis=0)
    assert marginal == pytest.approx(1.0, abs=0.25)
    assert joint == pytest.approx(1.0, abs=0.2)
