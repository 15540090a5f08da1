# SPDX-License-Identifier: MIT
"""A wrong side of the marker or height of the body is suspected; simulated walks."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.accuracy.drawn_walks.world import PLAIN, Spreads, draw_walk
from benchmarks.accuracy.tracked_walks import track_drawn_whole
from tracking.doubt import doubts


def said(*, side=1.0, height=0.0, seed=3) -> str:
    """Return the notes on a walk whose marker's side and body's height are stated wrong."""
    walk = draw_walk(np.random.default_rng(seed), lens=PLAIN, distance=2.6, spreads=Spreads())
    told = replace(
        walk.told, robot=walk.told.robot * [side, 1, 1, 1], height=walk.told.height + height
    )
    return " ".join(track_drawn_whole(replace(walk, told=told)).notes)


def test_a_sound_walk_raises_no_suspicion():
    assert said() == ""


@pytest.mark.parametrize("wrong", [{"side": 1.03}, {"height": 0.05}])
def test_what_is_wrong_is_among_those_named(wrong):
    name = "side of the robot's marker" if "side" in wrong else "height of the body"
    assert name in said(**wrong)


def test_what_is_taken_as_exact_is_not_suspected():
    walk = draw_walk(np.random.default_rng(3), lens=PLAIN, distance=2.6, spreads=Spreads())
    track = track_drawn_whole(walk).track
    sure = replace(track, stated=replace(track.stated, slots={}))
    assert doubts(sure) == ()
