# SPDX-License-Identifier: MIT
"""Frozen sensors, unreliable records and readings that wait in buffers stop the discs."""

from collections import deque

import numpy as np
import pytest

from rig.backends import RigDevices
from rig.clock import ManualClock
from rig.errors import RigError
from rig.experiment.bench import make_bench
from rig.links.byte_link import MemoryLink
from rig.links.packet import Kind, Packet, encode_packet
from rig.slip_rig.board import RigBoard


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
    spoil_records(twin, monkeypatch, spoil, after=2000)
    with pytest.raises(RigError, match=message):
        twin.run()
    assert twin.at_rest()


class LaggingLink(MemoryLink):
    """Hands on what the twin sends ever later, as a link does whose buffers fill.

    Args:
        growth: How much later a byte comes for each second that passes [-].
    """

    growth = 0.0

    def read(self, timeout):
        self.waiting = getattr(self, "waiting", deque())
        self.behind = getattr(self, "behind", 0.0)
        now = self._clock.now()
        self.behind += self.growth * (now - getattr(self, "read_at", now))
        self.read_at = now
        if data := super().read(timeout):
            self.waiting.append((now + self.behind, data))
        out = b""
        while self.waiting and self.waiting[0][0] <= now:
            out += self.waiting.popleft()[1]
        return out


def test_readings_that_come_ever_later_stop_the_discs(lab):
    twin = lab["twin"]()
    profile = twin.bench.profile
    clock = ManualClock()
    link = LaggingLink(twin.board, clock=clock)
    board = RigBoard(link, profile=profile.board, limits=profile.limits, clock=clock)
    twin.clock, twin.bench = clock, make_bench(RigDevices(profile, board=board))
    acquire = twin.acquisition(lab["plan"]())
    with twin.bench:
        twin.turn(acquire)
        link.growth = 0.5
        began = clock.now()
        with pytest.raises(RigError, match=r"age of .*'board' is .* s; its limit is 0\.25 s"):
            acquire.until(lambda _: False, 5.0)
        assert clock.now() - began < 1.0
    assert twin.at_rest()
