# SPDX-License-Identifier: MIT
"""Planted faults: as often as asked, the same for the same seed, and none on a perfect line."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.errors import ProtocolError
from rig.links.faults import PERFECT_LINE, Faults, FaultyLine, FaultyWire

FRAMES = [bytes([k % 256]) * 10 for k in range(2000)]
PROBABILITIES = [f.name for f in fields(Faults) if f.name != "noise_at_start"]


def carried(faults, frames=FRAMES, seed=1):
    return FaultyWire(faults, rng=np.random.default_rng(seed)).stream(frames)


@given(st.lists(st.binary(max_size=20)))
def test_a_perfect_line_passes_everything_unchanged(frames):
    assert carried(PERFECT_LINE, frames) == b"".join(frames)


@pytest.mark.parametrize("fault", PROBABILITIES)
def test_the_same_seed_plants_the_same_faults(fault):
    faults = Faults(**{fault: 0.1})
    assert carried(faults) == carried(faults)
    assert carried(faults) != carried(faults, seed=2)


@pytest.mark.parametrize(("fault", "expected"), [("drop", 0.8), ("duplicate", 1.2)])
def test_frames_are_lost_or_doubled_as_often_as_asked(fault, expected):
    assert len(carried(Faults(**{fault: 0.2}))) / 20_000 == pytest.approx(expected, abs=0.04)


def test_bits_flip_as_often_as_asked_and_nothing_else_changes():
    before = np.frombuffer(b"".join(FRAMES), np.uint8)
    after = np.frombuffer(carried(Faults(flip=0.01)), np.uint8)
    assert np.unpackbits(before ^ after).mean() == pytest.approx(0.01, rel=0.1)


def test_a_delayed_frame_comes_after_the_next_one():
    frames = [b"a", b"b", b"c"]
    wire = FaultyWire(Faults(delay=1.0), rng=np.random.default_rng(0))
    assert wire.stream(frames) == b"ab"  # the last one still waits
    assert wire.stream([b"d"]) == b"c"


def test_a_truncated_frame_is_the_beginning_of_it():
    frames = [bytes(range(10))]
    for seed in range(20):
        found = carried(Faults(truncate=1.0), frames, seed)
        assert len(found) < 10
        assert frames[0].startswith(found)


def test_noise_comes_once_before_the_first_frame():
    wire = FaultyWire(Faults(noise_at_start=7), rng=np.random.default_rng(0))
    assert wire.stream([b"abc"])[7:] == b"abc"
    assert wire.stream([b"abc"]) == b"abc"


@pytest.mark.parametrize("name", PROBABILITIES)
def test_what_is_no_probability_is_refused_by_name(name):
    with pytest.raises(ProtocolError, match=f"{name} is 1.5; expected a probability"):
        Faults(**{name: 1.5})


def test_frames_that_cannot_be_cut_arrive_whole_or_not_at_all():
    sent = [object() for _ in range(200)]
    rng = np.random.default_rng(0)
    line: FaultyLine[object] = FaultyLine(Faults(truncate=1.0, drop=0.2, delay=0.2), rng=rng)
    arrived = [frame for each in sent for frame in line.carry(each)]
    assert set(arrived) < set(sent)
    assert len(arrived) == len(set(arrived))
