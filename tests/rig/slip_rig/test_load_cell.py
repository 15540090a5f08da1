# SPDX-License-Identifier: MIT
"""The load cell's driver against its twin over UDP."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.links.faults import Faults
from rig.slip_rig.decode import decode_forces
from rig.slip_rig.load_cell import (
    MOST_IN_ONE,
    RECORD,
    REQUEST,
    SATURATED,
    NetFtCell,
    Request,
    describe_status,
)
from support.cell_twins import PROFILE, OneRead, twin


@pytest.mark.parametrize("buffered", [False, True])
def test_forces_are_the_rigs(buffered, take):
    with twin(buffered=buffered) as (_, stream), stream:
        samples = take(stream, 2000)
    forces = decode_forces(PROFILE, samples)
    assert forces.normal == pytest.approx(8.0, abs=1e-5)
    assert np.all(np.abs(forces.traction) < 0.5 * 8.0)
    assert stream.counters.lost == 0
    rate = (samples[-1].sequence - samples[0].sequence) / (
        samples[-1].device_time - samples[0].device_time
    )
    assert rate == pytest.approx(PROFILE.rate, rel=1e-6)


@pytest.mark.parametrize("buffered", [False, True])
@pytest.mark.parametrize("fault", ["drop", "duplicate", "delay", "truncate"])
def test_losses_are_counted_by_the_gaps_in_the_record_numbers(fault, buffered, take):
    with twin(Faults(**{fault: 0.05}), buffered=buffered) as (_, stream), stream:
        samples = take(stream, 4000)
    numbers = [sample.sequence for sample in samples]
    counters = stream.counters
    assert np.all(np.diff(numbers) > 0)
    assert counters.received + counters.lost == numbers[-1] - numbers[0] + 1
    assert counters.lost + counters.repeated + counters.damaged > 50
    assert counters.restarted == 0


def test_a_buffered_stream_takes_a_small_part_of_the_datagrams(monkeypatch, take):
    datagrams = []
    with twin(buffered=True) as (_, stream), stream:
        read = stream._link.read
        monkeypatch.setattr(
            stream._link, "read", lambda timeout: datagrams.extend(r := read(timeout)) or r
        )
        samples = take(stream, 500)
    assert len(samples) == MOST_IN_ONE * len(datagrams)


def test_a_cell_that_knows_no_buffered_stream_is_asked_for_single_records(monkeypatch, take):
    with twin(buffered=True) as (cell, stream):
        handle = cell._handle
        asked = []

        def ignore(data, sender):
            asked.append(REQUEST.unpack(data)[1])
            if asked[-1] != Request.START_BUFFERED:
                handle(data, sender)

        monkeypatch.setattr(cell, "_handle", ignore)
        with stream:
            take(stream, 1)
    assert asked[:2] == [Request.START_BUFFERED, Request.START]


def test_a_saturated_cell_says_so_in_every_sample(take):
    with twin() as (cell, stream), stream:
        cell.status = 1 << 31 | SATURATED
        status = take(stream, 3000)[-1].status
    assert describe_status(status) == "transducer saturated"


@given(st.lists(st.sampled_from([b"short", 1, 2, 3, 4, 5, 200]), max_size=12))
def test_a_read_keeps_each_record_with_its_own_counts(sent):
    datagrams = [
        item
        if isinstance(item, bytes)
        else RECORD.pack(item, 10 * item, 7, item, 0, -item, 0, 0, 0)
        for item in sent
    ]
    stream = NetFtCell(OneRead(*datagrams), profile=PROFILE)
    samples = stream.read(0.0)
    numbers = [s.sequence % 2**32 for s in samples]  # a jump back is a restart: they grow on
    assert [s.counts for s in samples] == [(n, 0, -n, 0, 0, 0) for n in numbers]
    assert all((s.status, s.channel) == (7, 0) for s in samples)
    counters = stream.counters
    assert (counters.received, counters.damaged) == (len(samples), sent.count(b"short"))
    assert counters.received + counters.repeated + counters.damaged == len(sent)


@given(st.binary(max_size=80))
def test_any_datagram_is_whole_records_or_damaged(datagram):
    stream = NetFtCell(OneRead(datagram), profile=PROFILE)
    samples = stream.read(0.0)
    whole = len(datagram) in (RECORD.size, 2 * RECORD.size)
    assert bool(samples) == whole
    assert stream.counters.damaged == (not whole)


@given(st.integers(0, 2**32 - 1))
def test_every_status_but_zero_is_spelled_out(status):
    if status & ~(1 << 31):
        assert describe_status(status)
