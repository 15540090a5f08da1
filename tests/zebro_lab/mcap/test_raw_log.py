# SPDX-License-Identifier: MIT
"""What is written is what was read, and what every ROS 2 tool reads."""

import io
import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from rig.device import Counters, Sample
from rig.imu.profile import load_imu_profile
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.profile import decode_angles, load_leg_profile
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.raw_log import RAW_SCHEMAS, decode_raw, encode_raw, read_raw_log
from zebro_lab.mcap.stream_views import DrivesView, ImuView, LegsView, LoadCellView, RigBoardView

START = 100.0
RIG = load_rig_profile("rig-odrive-netft")
BOARD = load_rig_profile("rig-board-serial")
LEGS = load_leg_profile("zebro-100-serial")
VIEWS = {
    "legs": LegsView("legs", profile=LEGS),
    "imu": ImuView("imu", profile=load_imu_profile("imu-quaternion-serial")),
    "drives": DrivesView("drives", profile=RIG.drives),
    "load_cell": LoadCellView("load_cell", profile=RIG.load_cell),
    "board": RigBoardView("board", profile=BOARD.board),
}
COUNTS = {
    "legs": (99, 1, 2, 3, 4, 5),
    "imu": (16384, 0, 0, 0, 90, 0, 0, 0, 0, 981),
    "drives": (1.25, 0.5),
    "load_cell": (1_000_000, 0, -6_000_000, 0, 0, 0),
    "board": (600_000, 100_000, 120_000, 30_000),
}


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


@given(samples(st.floats(allow_nan=False, allow_infinity=False)))
def test_values_with_fractions_round_trip(given_samples):
    dtype = RAW_SCHEMAS["zebro_lab/msg/RawValues"][0]
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


def log_of(stream, rows=3):
    """Return a log with a few samples of one stream, and those samples."""
    given_samples = [
        Sample(START + 0.01 * n, 0.01 * n, n, COUNTS[stream], 0, 1 if stream == "drives" else 0)
        for n in range(rows)
    ]
    file = io.BytesIO()
    writer = LogWriter(
        file, views={stream: VIEWS[stream]}, attachments={"profiles/x.toml": "schema = 1"},
        start=START, start_ns=10**18,
    )  # fmt: skip
    writer.write(stream, given_samples)
    writer.event(START, "hello")
    writer.count(START, stream, Counters(received=3, lost=1), dropped=2)
    writer.finish()
    file.seek(0)
    return file, given_samples


def by_topic(file):
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    found = {}
    for _, channel, message, decoded in reader.iter_decoded_messages():
        found.setdefault(channel.topic, []).append((message, decoded))
    return found


@pytest.mark.parametrize("stream", VIEWS)
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
    assert {field.name for field in fields(Counters)} < set(dir(counters))


@pytest.mark.parametrize("stream", VIEWS)
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


def test_joint_states_wrenches_and_imu_are_in_si():
    found = {}
    for stream in VIEWS:
        found |= by_topic(log_of(stream)[0])
    legs = found["/legs/joint_states"][0][1]
    assert legs.name == [f"leg_{n}" for n in range(1, 7)]
    np.testing.assert_allclose(legs.position, 2 * np.pi * np.array([-1, 1, 2, 3, 4, 5]) / 100)
    disc = found["/drives/joint_states"][0][1]
    assert (disc.name, disc.velocity) == (["ground_disc"], [pytest.approx(np.pi)])
    force = found["/load_cell/wrench"][0][1].wrench.force
    assert (force.x, force.z) == (1.0, 6.0)
    assert math.isnan(force.y)
    unit = found["/imu/data"][0][1]
    assert (unit.orientation.w, unit.header.frame_id) == (1.0, "body")
    assert unit.angular_velocity.x == pytest.approx(0.1)
    assert unit.linear_acceleration.z == pytest.approx(9.81)
    board = found["/board/joint_states"][0][1]
    assert board.velocity == [12.0, 3.0]


def test_shown_angles_go_on_where_the_batch_before_ended():
    turning = [
        Sample(0.01 * n, 0.01 * n, n, tuple((7 * n + leg) % 100 for leg in range(6)))
        for n in range(60)
    ]
    view = LegsView("legs", profile=LEGS)
    shown = [view._continued(turning[first : first + 7]) for first in range(0, 60, 7)]
    np.testing.assert_allclose(np.vstack(shown), decode_angles(LEGS, turning).theta)


def test_a_log_is_read_up_to_where_it_is_cut(tmp_path):
    path = tmp_path / "log.mcap"
    with path.open("wb") as file:
        writer = LogWriter(file, views={"legs": VIEWS["legs"]}, attachments={}, start=0.0,
                           start_ns=0)  # fmt: skip
        for n in range(50):
            writer.write("legs", [Sample(n / 10, n / 10, n, COUNTS["legs"])])
            writer.flush()
    whole = path.read_bytes()
    for kept in (0.3, 0.6, 0.95):
        path.write_bytes(whole[: int(kept * len(whole))])
        found = read_raw_log(path)
        assert found.damage is not None
        numbers = found.streams["/legs/raw"].sequence
        assert 5 < len(numbers) < 50
        np.testing.assert_array_equal(numbers, np.arange(len(numbers)))


@pytest.mark.parametrize("length", [2**63, 2**64 - 1, 2**40])
def test_a_length_beyond_the_file_is_damage(tmp_path, length):
    file, _ = log_of("legs", rows=40)
    path = tmp_path / "log.mcap"
    header = len(b"\x89MCAP0\r\n") + 1  # the first record's kind stands before its length
    data = bytearray(file.getvalue())
    data[header : header + 8] = length.to_bytes(8, "little")
    path.write_bytes(data)
    assert read_raw_log(path).damage is not None


def test_a_log_with_flipped_bytes_is_read_in_part_or_refused(tmp_path):
    file, _ = log_of("legs", rows=40)
    whole = file.getvalue()
    rng = np.random.default_rng(0)
    path = tmp_path / "log.mcap"
    for _ in range(300):
        data = bytearray(whole)
        for at in rng.integers(0, len(data), rng.integers(1, 4)):
            data[at] ^= 1 << rng.integers(8)
        path.write_bytes(data)
        try:
            found = read_raw_log(path)
        except DataError:
            continue
        for stream in found.streams.values():
            assert len(stream) <= 40
