# SPDX-License-Identifier: MIT
"""Sensors that lie are seen, and those that are coarse, at rest or without noise are let pass."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.device import Counters
from rig.errors import FrozenReading, StaleReading, UnreliableRecords
from rig.sensor_guards import AgeGuard, FrozenGuard, RecordGuard

LOOK = 0.01
EACH = 10
"""Readings of a look."""


def show(values, *, wanted=12.0, follows=False, limit=0.25):
    """Show a guard one channel's values, 1 kHz; return when it trips, None if never [s]."""
    guard = FrozenGuard("force", limit=limit, follows=follows)
    set_points = np.broadcast_to(wanted, len(values))
    for k in range(0, len(values), EACH):
        try:
            guard.check(
                values[k : k + EACH, None], wanted=float(set_points[k]), now=(k + EACH) / 1000
            )
        except FrozenReading:
            return (k + EACH) / 1000
    return None


def noisy(rng, n, size):
    """Make noise that forgets itself in 50 ms, in counts."""
    rho = np.exp(-0.001 / 0.05)
    path = np.zeros(n)
    for k, shock in enumerate(np.sqrt(1 - rho**2) * rng.standard_normal(n)):
        path[k] = rho * path[k - 1] + shock
    return np.rint(1000 + size * path)


@pytest.mark.parametrize("size", [50.0, 300.0, 30_000.0])
def test_a_noisy_sensor_that_freezes_is_seen_within_the_limit_and_a_look(size):
    for seed in range(20):
        values = noisy(np.random.default_rng(seed), 4000, size)
        assert show(values) is None
        values[2000:] = values[2000]
        assert show(values) == pytest.approx(2.265, abs=0.015)


@settings(max_examples=50)
@given(st.integers(0, 10_000), st.floats(0.05, 1000.0))
def test_noise_of_any_size_is_never_taken_for_frozen(seed, size):
    rng = np.random.default_rng(seed)
    assert show(np.rint(size * rng.standard_normal(3000))) is None


@settings(max_examples=30)
@given(st.floats(0.005, 0.5), st.floats(1.0, 1e7), st.floats(1.0, 12.0))
def test_a_speed_without_noise_may_settle_bit_for_bit(lag, scale, target):
    t = np.arange(5000) / 1000
    wanted = np.minimum(40.0 * t, target)
    speed = np.zeros(len(t))
    for k in range(1, len(t)):
        speed[k] = speed[k - 1] + (wanted[k] - speed[k - 1]) * min(0.001 / lag, 1.0)
    assert show(np.rint(scale * speed) / scale, wanted=wanted) is None
    assert show(np.rint(scale * speed) / scale, wanted=12.0) is None
    assert show(speed.astype(np.float32).astype(float), wanted=wanted) is None


def test_a_bump_without_noise_is_no_scatter():
    angle = np.mod(3.5 * np.arange(10_000) / 1000, 2 * np.pi)
    rise = np.where(angle < 1.0, 1 - np.cos(2 * np.pi * angle), 0.0)
    assert show(np.rint(1e5 * (8.0 + 2.4 * rise))) is None


def test_a_speed_that_stays_while_its_set_point_changes_is_frozen():
    wanted = np.minimum(40.0 * np.arange(1000) / 1000, 12.0)
    assert show(np.full(1000, 3.0), wanted=wanted, follows=True) < 0.4
    assert show(np.full(1000, 3.0), wanted=wanted) is None  # a force may stay the same


def test_a_sensor_at_rest_may_give_the_same_for_ever():
    values = noisy(np.random.default_rng(0), 6000, 300.0)
    values[2000:] = values[2000]
    assert show(values, wanted=np.where(np.arange(6000) < 2000, 12.0, 0.0)) is None


def test_a_reading_is_refused_by_its_age_alone():
    guard = AgeGuard("board", limit=0.25)
    guard.check(np.array([9.8, 9.9]), now=10.0)
    guard.check(np.empty(0), now=99.0)
    with pytest.raises(StaleReading, match=r"stream 'board' is 0\.3 s; its limit is 0\.25 s"):
        guard.check(np.array([9.7, 10.0]), now=10.0)


def test_one_restart_is_let_pass_and_a_second_soon_after_is_not():
    guard = RecordGuard("load_cell")
    guard.check(Counters(received=5, restarted=3), now=0.0)  # before watching began
    guard.check(Counters(received=50, restarted=4), now=1.0)
    guard.check(Counters(received=500, restarted=5), now=12.0)
    with pytest.raises(UnreliableRecords, match="restarted its numbering 2 times within 10 s"):
        guard.check(Counters(received=505, restarted=6), now=13.0)


@pytest.mark.parametrize("kind", ["lost", "damaged", "repeated", "refused"])
def test_a_stream_of_which_most_is_missing_is_not_believed(kind):
    guard = RecordGuard("board")

    def arrive(k, *, good, bad):
        guard.check(Counters(received=good, **{kind: bad}), now=k / 200)

    for k in range(200):  # a third is tolerated
        arrive(k, good=8 * k, bad=4 * k)
    arrive(200, good=1600, bad=800)
    with pytest.raises(UnreliableRecords, match=r"80 % of .* are missing, damaged, repeated or"):
        arrive(260, good=1600 + 20, bad=800 + 80)
