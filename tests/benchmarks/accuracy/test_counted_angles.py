# SPDX-License-Identifier: MIT

import numpy as np
import pytest

from benchmarks.accuracy import counted_angles
from benchmarks.accuracy.engine_walks import read_walk


def test_true_angles_of_two_speeds_are_judged_close_and_covered(monkeypatch):
    monkeypatch.setattr(counted_angles, "PLACES", 300)
    rng = np.random.default_rng(2)
    legs = counted_angles.two_speeds(rng)
    squared, half, most = counted_angles.judged(legs, np.radians(3.6), 50.0, rng)
    assert 0 < np.degrees(np.sqrt(squared)) < 0.3
    assert 0.4 < half < most
    assert most > 0.85


@pytest.mark.reference
def test_a_walk_counted_from_another_zero_is_the_same_walk(shared):
    one = read_walk(shared / "virtual-world/walks/tripod_s1.20_left_mu0.38_tc2.json")
    t = one.log.t[100:-100]
    for zero in (0.0, 0.3 * counted_angles.STEP):
        rebuilt = counted_angles.counted_from(one, zero)
        assert np.degrees(np.abs(rebuilt.angles(t) - one.log.angles(t)).max()) < 0.3
