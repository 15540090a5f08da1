# SPDX-License-Identifier: MIT
"""Logs are read by public tools alone."""

from dataclasses import fields

import numpy as np
import pytest
from mcap.reader import make_reader

from rig.device import Counters as DeviceCounters
from support.logs import STREAMS, by_topic, log_of


@pytest.mark.parametrize("stream", STREAMS)
def test_public_tools_alone_read_raw_counts_events_and_counters(stream):
    file, given_samples = log_of(stream)
    found = by_topic(file)
    ((_, raw),) = found[f"/{stream}/raw"]
    np.testing.assert_allclose(raw.host_time, [0.0, 0.01, 0.02])
    assert raw.sequence == [0, 1, 2]
    assert raw.counts == [count for sample in given_samples for count in sample.counts]
    ((message, event),) = found["/events"]
    assert (event.msg, message.log_time) == ("hello", 10**18)
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
