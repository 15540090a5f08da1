# SPDX-License-Identifier: MIT
"""What is written is what was read, and what every ROS 2 tool reads."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.device import Sample
from support.logs import COUNTS, START, log_of
from zebro_lab.mcap.raw_log import RAW_SCHEMAS, decode_raw, encode_raw, raw_topic, read_raw_log


@st.composite
def samples(draw, counts):
    width = draw(st.integers(1, 7))
    number = st.none() | st.integers(0, 2**62)
    one = st.builds(
        Sample,
        host_time=st.floats(0, 1e6),
        device_time=st.none() | st.floats(0, 1e6),
        sequence=number,
        counts=st.tuples(*[counts] * width),
        status=st.integers(0, 2**32 - 1),
        channel=st.integers(0, 63),
    )
    return draw(st.lists(one, min_size=1, max_size=5))


def same(found, wanted):
    return all(
        a[1:] == b[1:] and math.isclose(a.host_time, b.host_time, abs_tol=1e-9)
        for a, b in zip(found, wanted, strict=True)
    )


@given(samples(st.integers(-(2**31), 2**31 - 1)))
def test_whole_counts_round_trip(given_samples):
    dtype = RAW_SCHEMAS["zebro_lab/msg/RawCounts"][0]
    data = encode_raw(given_samples, dtype=dtype, start=0.0)
    assert same(decode_raw(data, dtype=dtype), given_samples)


@given(st.binary(max_size=200))
def test_any_bytes_are_samples_or_a_value_error(data):
    for payload in (data, b"\0\1\0\0" + data):
        try:
            found = decode_raw(payload, dtype="<i4")
        except ValueError:
            continue
        assert len(list(found)) == len(found)


@pytest.mark.parametrize("stream", COUNTS)
def test_a_log_is_read_back_with_every_sample(stream, tmp_path):
    file, given_samples = log_of(stream)
    (tmp_path / "log.mcap").write_bytes(file.getvalue())
    found = read_raw_log(tmp_path / "log.mcap")
    assert found.damage is None
    assert list(found.streams) == [raw_topic(stream)]
    since_start = [each._replace(host_time=each.host_time - START) for each in given_samples]
    assert same(found.streams[raw_topic(stream)], since_start)
