# SPDX-License-Identifier: MIT
"""Frozen sensors, unreliable records and readings that wait in buffers stop the discs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.device import Counters
from rig.errors import FrozenReading, RigError, StaleReading, UnreliableRecords
from rig.experiment.guards import AgeGuard, FrozenGuard, RecordGuard
from rig.links.packet import Kind, Packet, encode_packet


def spoil_records(twin, monkeypatch, spoil, *, after=0):
    """Let `spoil` change number and counts of every record beyond the first ones."""
    body = twin.board._body
    sent = []

    def encode(number, counts):
        sent.append(number)
        ticks = round(number / twin.bench.profile.board.rate * 1e6)
        if len(sent) > after:
            number, counts = spoil(number, counts)
        return encode_packet(Packet(Kind.SLIP_RIG, number, ticks, body.pack(*counts)))

    monkeypatch.setattr(twin.board, "_encode", encode)


def test_speeds_frozen_bit_for_bit_while_the_discs_turn_stop_them(lab, monkeypatch):
    twin = lab["twin"]()
    frozen = []
    acquire = twin.acquisition(lab["plan"]())

    def freeze(number, counts):
        return number, (*counts[:2], *(frozen or counts[2:4]), counts[4])

    spoil_records(twin, monkeypatch, freeze)
    with twin.bench:
        twin.turn(acquire)
        acquire.until(lambda _: False, 1.0)
        frozen += [round(12.0 * 10_000), round(2.8 * 10_000)]
        began = twin.clock.now()
        with pytest.raises(RigError, match=r"speed of the leg disc stayed the same.* 0\.25 s"):
            acquire.until(lambda _: False, 5.0)
        assert twin.clock.now() - began < 0.3
    assert twin.at_rest()


RNG = np.random.default_rng(0)
SPOILED = {
    "frozen": (
        lambda number, c: (number, (400_000, 100_000, *c[2:])),
        r"forces .* stayed the same.*; the limit is 0\.25 s"),
    "restarting": (  # 20 times a second at 1 kHz
        lambda number, c: (1_000_000 * (number // 50) + number % 50, c),
        r"stream 'board'.* numbering"),
    "numbered at random": (
        lambda number, c: (int(RNG.integers(1 << 32)), c), r"stream 'board'.* numbering"),
    "two of three beyond the limit": (
        lambda number, c: (number, c if number % 3 == 0 else ((1 << 31) - 1, *c[1:])),
        r"normal force is .* N; its limit is 25 N"),
}  # fmt: skip


@pytest.mark.parametrize(("spoil", "message"), SPOILED.values(), ids=SPOILED)
def test_records_that_cannot_be_believed_stop_the_discs(lab, monkeypatch, spoil, message):
    twin = lab["twin"]()
    spoil_records(twin, monkeypatch, spoil, after=2500)
    with pytest.raises(RigError, match=message):
        twin.run()
    assert twin.at_rest()


def test_readings_that_come_ever_later_stop_the_discs(lab, lagging):
    twin = lab["twin"]()
    link, acquire = lagging(twin, lab["plan"]())
    with twin.bench:
        twin.turn(acquire)
        link.growth = 0.5
        began = twin.clock.now()
        with pytest.raises(RigError, match=r"age of .*'board' is .* s; its limit is 0\.25 s"):
            acquire.until(lambda _: False, 5.0)
        assert twin.clock.now() - began < 1.0
    assert twin.at_rest()


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
    with pytest.raises(UnreliableRecords, match=r"restarted its numbering .* 2 times within 10 s"):
        guard.check(Counters(received=505, restarted=6), now=13.0)


@pytest.mark.parametrize("what", ["restarted", "reconnected"])
def test_no_restart_of_what_turns_the_discs_is_let_pass(what):
    guard = RecordGuard("board", turns_discs=True)
    guard.check(Counters(received=5, **{what: 3}), now=0.0)  # before it was energised
    guard.check(Counters(received=50, **{what: 3}), now=1.0)
    with pytest.raises(UnreliableRecords, match="allowed: 0"):
        guard.check(Counters(received=51, **{what: 4}), now=100.0)


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
