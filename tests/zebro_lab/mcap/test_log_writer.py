# SPDX-License-Identifier: MIT
"""Logs are read by public tools alone, and take no memory while they grow."""

import resource
import tracemalloc
from collections import Counter
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from rig.clock_watch import ClockWatch
from rig.device import Counters as DeviceCounters
from rig.device import Sample
from rig.sample_columns import SampleColumns
from support.logs import COUNTS, STREAMS, by_topic, log_of
from zebro_lab.mcap.log_writer import LogWriter


@pytest.mark.parametrize("stream", STREAMS)
def test_public_tools_alone_read_raw_counts_events_and_counters(stream):
    file, given_samples = log_of(stream)
    found = by_topic(file)
    ((_, raw),) = found[f"/{stream}/raw"]
    np.testing.assert_allclose(raw.host_time, [0.0, 0.01, 0.02])
    assert raw.sequence == [0, 1, 2]
    assert raw.counts == [count for sample in given_samples for count in sample.counts]
    ((message, event),) = found["/events"]
    assert (event.msg, message.publish_time) == ("hello", 10**18)
    ((_, counters),) = found[f"/{stream}/counters"]
    assert (counters.received, counters.lost, counters.dropped) == (3, 1, 2)
    assert {field.name for field in fields(DeviceCounters)} < set(dir(counters))


@pytest.mark.parametrize("stream", STREAMS)
def test_the_log_alone_names_counts_and_units_and_keeps_the_profile(stream):
    file, _ = log_of(stream)
    reader = make_reader(file)
    summary = reader.get_summary()
    channels = {c.topic: c for c in summary.channels.values()}
    metadata = channels[f"/{stream}/raw"].metadata
    assert metadata["counts"]
    assert metadata["unit"]
    schemas = {schema.name: schema.data.decode() for schema in summary.schemas.values()}
    assert "[s]" in next(text for name, text in schemas.items() if "Raw" in name)
    (attachment,) = reader.iter_attachments()
    assert (attachment.name, attachment.data) == ("profiles/x.toml", b"schema = 1")


def test_a_log_is_read_by_rosbags_too_in_whatever_order_things_are_stamped(tmp_path):
    highlevel = pytest.importorskip("rosbags.highlevel")
    typesys = pytest.importorskip("rosbags.typesys")
    streams = {name: STREAMS[name] for name in ("board", "legs")}
    with (tmp_path / "log.mcap").open("wb") as file:
        writer = LogWriter(file, streams=streams, attachments={}, start=0.0, start_ns=10**18)
        for chunk in range(10):
            for name, late in (("board", 0.09), ("legs", 0.02)):
                time = chunk / 10 + late
                writer.write(name, [Sample(time, time, chunk, COUNTS[name])])
            writer.event(chunk / 10 - 0.05, "late")
            writer.flush()
        writer.finish()
    types = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    with highlevel.AnyReader([tmp_path / "log.mcap"], default_typestore=types) as reader:
        found = Counter(connection.topic for connection, *_ in reader.messages())
    assert found == {"/board/raw": 10, "/legs/raw": 10, "/events": 10}


class Nowhere:
    """A file that keeps nothing of what is written, but how much."""

    def __init__(self):
        self.size = 0

    def write(self, data):
        self.size += len(data)
        return len(data)

    def tell(self):
        return self.size

    def flush(self):
        """Do nothing."""


def test_a_log_in_the_making_needs_no_more_memory_the_longer_it_is():
    streams = {"board": STREAMS["board"]}
    writer = LogWriter(Nowhere(), streams=streams, attachments={}, start=0.0, start_ns=0)
    taken = []
    tracemalloc.start()
    try:
        for chunk in range(2400):
            writer.event(chunk / 10, "hello")
            writer.flush()
            if chunk in (600, 2399):
                taken.append(tracemalloc.get_traced_memory()[0])
    finally:
        tracemalloc.stop()
    assert taken[1] < 1.2 * taken[0]
    writer.finish()


HOUR = 36_000
"""Number of chunks that a recorder writes in an hour."""


def resident():
    """Return the memory of this process [bytes]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_a_day_of_a_board_and_a_load_cell_needs_the_memory_of_two_hours():
    streams = {name: STREAMS[name] for name in ("board", "load_cell")}
    writer = LogWriter(Nowhere(), streams=streams, attachments={}, start=0.0, start_ns=0)
    watches = {name: ClockWatch(start=0.0) for name in streams}
    batches = {"board": batch(4, 1e3), "load_cell": batch(6, 7e3)}
    taken = {}
    for chunk in range(24 * HOUR + 1):
        for name, samples in batches.items():
            part = replace(samples, host_time=samples.host_time + chunk / 10,
                           device_time=samples.device_time + chunk / 10)  # fmt: skip
            writer.write(name, part)
            for read in range(0, len(part), len(part) // 4):
                watches[name].add(part[read : read + len(part) // 4])
        writer.flush()
        if chunk % (2 * HOUR) == 0:
            taken[chunk // HOUR] = resident()
    writer.finish()
    assert taken[24] < 1.2 * taken[2], taken
    assert all(abs(watch.result()["drift"]) < 1e-9 for watch in watches.values())


def batch(width, rate):
    """Return the samples of 0.1 s."""
    n = round(rate / 10)
    host = np.arange(n) / rate
    counts = np.random.default_rng(0).integers(0, 1 << 20, (n, width), dtype="i4")
    zeros = np.zeros(n, dtype="u4")
    return SampleColumns(host, host - 5.0, np.arange(n), zeros, zeros, counts)
