# SPDX-License-Identifier: MIT
"""A range holds exactly the numbers that it describes."""

import math

import pytest

from zebro_lab.terminal.limits import Range


@pytest.mark.parametrize(
    ("limits", "text", "inside", "outside"),
    [
        (Range(least=90, below=360), "90 or more and below 360", (90, 359.9), (89.9, 360)),
        (Range(above=0), "above 0", (5e-324, 1e308), (0, -1)),
        (Range(least=0, most=1), "0 to 1", (0, 1), (-0.1, 1.1)),
        (Range(above=0, most=30), "above 0 and at most 30", (1, 30), (0, 30.1)),
        (Range(), "", (-1e308, 0), ()),
    ],
)
def test_limits_hold_what_they_say(limits, text, inside, outside):
    assert str(limits) == text
    assert all(map(limits.hold, inside))
    assert not any(map(limits.hold, (*outside, math.nan, math.inf, -math.inf)))
