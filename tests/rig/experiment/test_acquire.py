# SPDX-License-Identifier: MIT
"""Broken sensors, readings that wait in buffers, and proof that the discs stand."""

from collections import deque

import pytest

from rig.backends import RigDevices
from rig.clock import ManualClock
from rig.errors import RigError
from rig.experiment.acquire import Acquisition
from rig.experiment.bench import make_bench
from rig.links.memory import MemoryLink
from rig.links.packet import Kind, Packet, encode_packet
from rig.slip_rig.board import RigBoard

NOT_RAISED = pytest.fail.Exception


def acquisition(twin, plan):
    return Acquisition(
        twin.bench, limits=plan.limits, control=twin.control, sink=twin.sink, clock=twin.clock,
        period=0.01,
    )  # fmt: skip


def turn(acquire, leg=12.0, slip=0.2):
    acquire.arm()
    acquire.aim(leg, slip)
    acquire.until(lambda _: not acquire.ramping, 2.0)


def keep_turning(twin, monkeypatch, slowest):
    """Let the leg disc turn with at least some speed, whatever is commanded [rad/s]."""
    command = twin.rig.command
    monkeypatch.setattr(
        twin.rig,
        "command",
        lambda disc, omega: command(disc, max(omega, slowest) if disc == "leg" else omega),
    )


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


@pytest.mark.xfail(strict=True, raises=NOT_RAISED)
def test_readings_that_come_ever_later_stop_the_discs(lab):
    twin = lab["twin"]()
    profile = twin.bench.profile
    clock = ManualClock()
    link = LaggingLink(twin.board, clock=clock)
    board = RigBoard(link, profile=profile.board, limits=profile.limits, clock=clock)
    twin.clock, twin.bench = clock, make_bench(RigDevices(profile, board=board))
    acquire = acquisition(twin, lab["plan"]())
    with twin.bench:
        turn(acquire)
        link.growth = 0.5
        began = clock.now()
        with pytest.raises(RigError, match=r"age of .*'board' is .* s; its limit is 0\.25 s"):
            acquire.until(lambda _: False, 5.0)
        assert clock.now() - began < 1.0
    assert twin.at_rest()
