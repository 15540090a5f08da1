# SPDX-License-Identifier: MIT
"""Which photograph to annotate next is chosen by what it would bring; a simulated walk."""

import numpy as np

from support.drawn_tracks import track_unmarked
from support.drawn_walks import PLAIN, Spreads, draw_walk


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
