# SPDX-License-Identifier: MIT
"""Stops and their order."""

from hypothesis import given
from hypothesis import strategies as st

from rig.safety import StopCategory, StopSwitch


@given(st.lists(st.sampled_from(list(StopCategory)), min_size=1, max_size=6))
def test_the_hardest_stop_prevails_and_only_soft_ones_are_released(asked):
    switch = StopSwitch()
    for category in asked:
        switch.request(category, category.name)
    assert switch.pending.category is max(asked)
    assert switch.latched == (StopCategory.EMERGENCY in asked)
    switch.release()
    left = [category for category in asked if category is not StopCategory.SOFT]
    assert (switch.pending.category if switch.pending else None) == max(left, default=None)
    switch.reset()
    assert switch.pending is None
