# SPDX-License-Identifier: MIT
"""An exposure raises the likelihood of a picture of darkest values where it is."""

import numpy as np

from support.drawn_board import composite, likeness
from tracking.composite.darkest import DarkestReading
from tracking.composite.steps import steady_chain

WALK = steady_chain(np.array([-0.15, -0.05, 0.15]), np.array([0.14, 0.0, 0.1]), 0.0, 2, 0)


def test_an_exposure_gains_where_it_is_and_not_beside():
    picture = likeness(composite(WALK, "darkest"), WALK[0], reach=0.3)
    reading = DarkestReading.of(picture, cells=24)
    look = reading.look(WALK[:2])
    cover = reading.cover(WALK[:2], look)
    tried = np.array([WALK[2], WALK[2] + [0.0, 0.15, 0.0]])
    gain, claim, inside = reading.gains(tried, look, cover, reading.body)
    assert gain.shape == claim.shape == inside.shape == (2,)
    assert gain[0] > 0.1 > gain[1]
    assert claim[0] > 0.3
    assert inside[0] == 1.0
