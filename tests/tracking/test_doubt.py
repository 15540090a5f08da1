# SPDX-License-Identifier: MIT
"""A stated value that is wrong is named, alone or among those that cannot be told apart."""

from dataclasses import replace

import numpy as np
import pytest

from support.drawn_tracks import track_marked
from support.drawn_walks import PLAIN, WIDE, DrawnWalk, Spreads, Told, draw_walk
from tracking.doubt import doubts
from tracking.errors import FloorError

FAULTS = {
    "side of the robot's marker": lambda told: {"robot": told.robot * [1.02, 1, 1, 1]},
    "its print is turned": lambda told: {"robot": told.robot + TURN},
    "height of the body": lambda told: {"height": told.height + 0.03},
    "place of mark 11": lambda told: {"marks": {**told.marks, 11: told.marks[11] + SHIFT}},
    "focal length": lambda told: {"lens": told.lens * np.repeat([1.02, 1], [2, 7])},
    "the map of the floor is mirrored": lambda told: {
        "marks": {number: mark * [1, -1, -1, 1] for number, mark in told.marks.items()}
    },
}
"""What names a wrong value, and the value that is told instead."""
TURN = np.array([0, 0, 0, np.pi])
SHIFT = np.array([0.0048, 0.0064, 0, 0])  # 8 mm


def drawn(seed: int = 5001) -> DrawnWalk:
    """Draw a walk of which all is told as it is, but for the errors that are told with it."""
    rng, lens = np.random.default_rng(seed), (PLAIN, WIDE)[seed % 2]
    return draw_walk(rng, lens=lens, distance=2.6, spreads=Spreads())


def said(told: Told, walk: DrawnWalk) -> str:
    """Return the notes on a walk, or why its floor is refused, where something else is told."""
    try:
        return " ".join(track_marked(replace(walk, told=told)).notes)
    except FloorError as error:
        return str(error)


@pytest.fixture(scope="module")
def sound():
    """Track a walk of which all is told as it is."""
    return track_marked(drawn())


def test_a_sound_walk_raises_no_suspicion(sound):
    assert sound.notes == ()


@pytest.mark.parametrize("words", FAULTS)
def test_what_is_wrong_is_among_those_named(words):
    walk = drawn()
    assert words in said(replace(walk.told, **FAULTS[words](walk.told)), walk)


def test_what_is_taken_as_exact_is_not_suspected(sound):
    track = sound.track
    sure = replace(track, stated=replace(track.stated, slots={}))
    assert doubts(sure) == ()
