# SPDX-License-Identifier: MIT
"""Tracks of drawn walks err as much as their covariances say; a long test judges it by many."""

import numpy as np
import pytest

from benchmarks.accuracy.drawn_walks.world import (
    PLAIN,
    WIDE,
    Spreads,
    draw_walk,
    places_on_top,
    top_in_photo,
)
from benchmarks.accuracy.tracked_walks import Job, jobs, score, track_unmarked


def test_walks_are_drawn_with_both_lenses_at_all_distances():
    drawn = jobs(20, None)
    assert {job.lens.focal for job in drawn} == {(1394.0, 1394.0), (980.0, 982.0)}
    assert len({job.distance for job in drawn}) == 5
    assert len({job.spreads.edges for job in drawn}) == 20


@pytest.mark.parametrize("annotated", [0, 1, 3])
def test_a_walk_is_scored_by_its_covariance(annotated):
    scored = score(Job(1, PLAIN, 2.6, Spreads(), annotated))
    assert 0.1 < scored.marginal < 5
    assert 0.1 < scored.joint < 5
    assert np.all(scored.sd > 0)


def test_places_on_the_top_are_found_from_their_pixels():
    walk = draw_walk(np.random.default_rng(2), lens=WIDE, distance=2.6, spreads=Spreads())
    places = np.array([[0.08, -0.05], [-0.02, 0.07], [0.0, 0.0]])
    pixels = top_in_photo(walk, 3, places)
    np.testing.assert_allclose(places_on_top(walk, 3, pixels), places, atol=1e-9)


def test_a_further_annotation_brings_what_was_promised_and_more_of_them_less():
    walk = draw_walk(np.random.default_rng(3), lens=PLAIN, distance=3.4, spreads=Spreads())
    tracks = [track_unmarked(walk, np.random.default_rng(0), n) for n in (1, 2, 5)]
    first, second, many = (each.next_annotation for each in tracks)
    assert first is not None
    assert first.yaw > 0.1
    assert "annotate the robot's top in p" in first.sentence
    sd = [np.sqrt(np.mean(each.track.covariance[:, 2, 2])) for each in tracks]
    assert 1 - sd[1] / sd[0] > 0.7 * first.yaw
    assert sd[2] < 0.7 * sd[0]
    assert second is None or second.yaw < first.yaw
    assert many is None or many.yaw < first.yaw


@pytest.mark.long
@pytest.mark.parametrize("annotated", [0, 1, 3])
def test_errors_are_as_large_as_the_covariances_say(annotated):
    edges = 0.03 if annotated else None
    scored = [score(job) for job in jobs(60, edges, annotated=annotated)]
    assert np.mean([each.marginal for each in scored]) == pytest.approx(1.0, abs=0.25)
    assert np.mean([each.joint for each in scored]) == pytest.approx(1.0, abs=0.2)
