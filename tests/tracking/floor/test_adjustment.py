# SPDX-License-Identifier: MIT
"""Lens, camera, marks and edges are estimated together, and err by their joint covariance."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_floor import FLOOR, LENS, camera_pose, see
from tracking.floor import FloorMap, FloorView
from tracking.floor.adjustment import Adjustment
from tracking.floor.edge_spread import EDGE_SPREADS, EdgeSpread
from tracking.markers import edge_growth
from tracking.shared import LENS as LENS_ERROR
from tracking.shared import mark_name, stand_name

TRUE = camera_pose()
LENS_SD = np.array([4.0, 4.0, 3.0, 3.0, 4e-3, 0, 0, 0, 0])


def outwards(view: FloorView, by: dict[int | str, float]) -> FloorView:
    """Move the edges of each marker outwards [px]."""
    pixels = {key: each + by[key] * edge_growth(each) for key, each in view.pixels.items()}
    return replace(view, pixels=pixels)


def taped(rng: np.random.Generator) -> FloorMap:
    """Measure the floor with a tape."""
    return FloorMap(
        "4x4_50", tuple(m.moved(m.prior_sd * rng.normal(size=4)) for m in FLOOR.markers)
    )


def adjusted(rng, *, camera=LENS, floor=FLOOR, by=0.0, scatter=0.0, edge_sd=0.05):
    """Fit one stand; return problem, solution and joint covariance."""
    view = see(FLOOR, TRUE, rng)
    view = outwards(view, {key: by + scatter * rng.normal() for key in view.pixels})
    problem = Adjustment(camera, floor, [view], [TRUE], edge_sd)
    found, factors = problem.solve()
    return problem, found, problem.shared_errors(found, factors)


def test_edges_that_all_markers_share_are_found_and_shrunk_by_the_prior():
    found = [adjusted(np.random.default_rng(k), by=0.2, edge_sd=0.2)[1].edges[0] for k in range(8)]
    assert np.mean(found) == pytest.approx(0.2 * 4 / 5, abs=0.03)  # four markers and one prior


def test_all_unknowns_err_by_their_joint_covariance():
    rng, squares = np.random.default_rng(1), []
    for _ in range(30):
        off = LENS_SD * rng.normal(size=9)
        told = replace(LENS.changed(off), covariance=np.diag(LENS_SD**2))
        problem, found, shared = adjusted(rng, camera=told, floor=taped(rng), edge_sd=1e-4)
        lens = problem.lens(found)
        fitted = np.concatenate((lens.matrix[[0, 1, 0, 1], [0, 1, 2, 2]], lens.distortion))
        true = np.array([1400.0, 1400.0, 640.0, 480.0, 0, 0, 0, 0, 0])
        (pose,) = found.poses
        error = np.concatenate((
            (fitted - true)[:5],
            pose.rotation_vector - TRUE.rotation_vector, pose.translation - TRUE.translation,
            *(np.subtract([m.x, m.y, m.yaw, m.side], [t.x, t.y, t.yaw, t.side])
              for m, t in zip(found.floor.markers, FLOOR.markers, strict=True)),
        ))  # fmt: skip
        rows = np.arange(shared.size)
        kept = np.concatenate((
            rows[shared.slots[LENS_ERROR]][:5], rows[shared.slots[stand_name(0)]],
            *(rows[shared.slots[mark_name(m.marker_id)]] for m in FLOOR.markers),
        ))  # fmt: skip
        covariance = shared.covariance[np.ix_(kept, kept)]
        squares.append(error @ np.linalg.solve(covariance, error) / len(kept))
    assert np.mean(squares) == pytest.approx(1.0, abs=0.15)  # 27 x 30 degrees of freedom


def test_the_spread_of_edges_is_that_by_which_sizes_scatter():
    told = {}
    for scatter in (0.0, 0.3):
        view = see(FLOOR, TRUE, np.random.default_rng(4))
        rng = np.random.default_rng(5)
        view = outwards(view, {key: scatter * rng.normal() for key in view.pixels})
        told[scatter] = Adjustment(LENS, FLOOR, [view], [TRUE]).edges().sd
    assert told[0.0] < 0.08
    assert 0.15 < told[0.3] < 0.4


def test_without_markers_the_spread_is_the_prior_s():
    spread = EdgeSpread(np.zeros(len(EDGE_SPREADS)))
    assert spread.weights.sum() == pytest.approx(1.0)
    assert spread.sd == pytest.approx(np.sqrt(np.mean(EDGE_SPREADS**2)))


def test_the_derivative_of_edges_moves_corners_outwards_more_where_it_is_far():
    problem, _, _ = adjusted(np.random.default_rng(6))
    near, far = FLOOR.markers[0], FLOOR.markers[2]
    for marker, sign in ((near, -1), (far, 1)):
        corners = see(FLOOR, TRUE, np.random.default_rng(0)).pixels[marker.marker_id]
        by = problem.edge_derivative(corners, marker.points, TRUE)
        outward = corners - corners.mean(axis=0)
        assert np.sum(by[:, :, 0] * outward) > 0
        assert np.sign(np.sum(by[:, :, 1] * outward)) == sign
