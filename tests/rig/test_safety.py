# SPDX-License-Identifier: MIT
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.device import Sample
from rig.errors import LimitExceeded, RigError, RigTimeout
from rig.safety import FollowingGuard, SampleGuard, SilenceGuard, require_within


@given(st.floats(allow_nan=True), st.floats(0.1, 100))
def test_a_set_point_passes_exactly_within_its_limit(value, limit):
    if not math.isnan(value) and abs(value) <= limit:
        require_within(value, limit, quantity="speed", unit="rad/s")
    else:
        with pytest.raises(LimitExceeded, match="rad/s; its limit is"):
            require_within(value, limit, quantity="speed", unit="rad/s")


@given(
    st.lists(st.lists(st.sampled_from([0.0, 50.0, math.nan]), max_size=8), max_size=8),
    st.integers(1, 4),
)
def test_a_guard_trips_where_most_of_the_latest_samples_are_beyond(looks, in_a_row):
    guard = SampleGuard(30.0, quantity="normal force", unit="N", in_a_row=in_a_row)
    seen = []
    for look in looks:
        trips = False
        for value in look:
            seen.append(value != 0)
            trips |= seen[-1] and sum(seen[-(2 * in_a_row - 1) :]) >= in_a_row
        if trips:
            with pytest.raises(LimitExceeded, match="normal force is"):
                guard.check_all(np.array(look))
            return
        guard.check_all(np.array(look))


@given(st.integers(2, 10), st.randoms())
def test_a_guard_trips_where_two_samples_of_three_are_beyond(in_a_row, random):
    guard = SampleGuard(30.0, quantity="normal force", unit="N", in_a_row=in_a_row)
    start = random.randrange(3)
    values = [50.0 if k % 3 else 0.0 for k in range(start, start + 4 * in_a_row)]
    with pytest.raises(LimitExceeded, match="normal force is 50 N"):
        guard.check_all(np.array(values))


def test_silence_is_an_event_that_names_the_stream():
    guard = SilenceGuard("legs", limit=0.5, now=10.0)
    guard.check([], now=10.4)
    guard.check([Sample(10.4, None, None, ())], now=10.4)
    guard.check([], now=10.8)
    with pytest.raises(RigTimeout, match=r"'legs' sent nothing within 0\.6 s") as silence:
        guard.check([], now=11.0)
    assert isinstance(silence.value, RigError | TimeoutError)


def test_a_speed_off_its_set_point_trips_only_when_it_stays_off():
    guard = FollowingGuard(2.0, name="leg disc", longest=0.5)
    guard.check(9.0, 12.0, now=1.0)
    guard.check(10.5, 12.0, now=1.4)  # within again: the time starts anew
    guard.check(9.0, 12.0, now=1.6)
    guard.check(9.0, 12.0, now=2.0)
    with pytest.raises(LimitExceeded, match="speed error of the leg disc") as raised:
        guard.check(9.0, 12.0, now=2.1)
    assert (raised.value.value, raised.value.limit) == (-3.0, 2.0)


@pytest.mark.parametrize(("speed", "narrower"), [(math.nan, math.inf), (12.5, 0.3)])
def test_no_speed_and_one_beyond_a_narrower_limit_are_off(speed, narrower):
    guard = FollowingGuard(2.0, name="leg disc", longest=0.0)
    with pytest.raises(LimitExceeded):
        guard.check(speed, 12.0, now=1.0, narrower=narrower)
