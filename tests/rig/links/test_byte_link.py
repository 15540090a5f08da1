# SPDX-License-Identifier: MIT
"""A link in memory: what is written reaches the twin, waiting lets its clock pass."""

from rig.clock import ManualClock
from rig.links.byte_link import MemoryLink


class Twin:
    """Answers each byte after 0.05 s."""

    source = "sim:echo"

    def __init__(self):
        self.received = []

    def poll(self, now, received):
        if received:
            self.received.append((now, received))
        due = [part for at, part in self.received if at + 0.05 <= now]
        self.received = [each for each in self.received if each[0] + 0.05 > now]
        return b"".join(due)


def test_an_answer_comes_when_it_is_due():
    clock, twin = ManualClock(), Twin()
    link = MemoryLink(twin, clock=clock)
    link.open()
    assert link.write(b"ab")
    assert link.read(0.02) == b""
    assert clock.now() == 0.02
    assert link.read(1.0) == b"ab"
    assert 0.05 <= clock.now() < 0.08
    assert (link.source, link.reconnected) == ("sim:echo", 0)


def test_reading_without_waiting_lets_no_time_pass():
    clock = ManualClock(3.0)
    assert MemoryLink(Twin(), clock=clock).read(0.0) == b""
    assert clock.now() == 3.0


def test_closing_hands_over_what_was_written_last():
    twin = Twin()
    link = MemoryLink(twin, clock=ManualClock())
    link.write(b"stop")
    link.close()
    assert twin.received == [(0.0, b"stop")]
