# SPDX-License-Identifier: MIT
"""A stated value that is wrong is named, alone or among those that cannot be told apart."""

import pytest

from benchmarks.accuracy.planted_track_faults import FAULTS, SOUND, notes_of


@pytest.mark.parametrize("fault", FAULTS)
def test_what_is_wrong_is_named(fault):
    assert FAULTS[fault].words in notes_of((fault, 1.0, 1))[2]


def test_a_sound_walk_draws_no_remark():
    assert notes_of((SOUND, 0.0, 1))[2] == ""


@pytest.mark.long
@pytest.mark.parametrize("fault", FAULTS)
def test_most_are_named_and_few_sound_walks_draw_remarks(fault):
    assert sum(FAULTS[fault].words in notes_of((fault, 1.0, seed))[2] for seed in range(10)) >= 7
    assert sum(bool(notes_of((SOUND, 0.0, seed))[2]) for seed in range(10)) <= 1
