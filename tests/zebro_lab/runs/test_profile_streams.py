# SPDX-License-Identifier: MIT
"""A stored profile tells which streams its device has, and what their counts are."""

import pytest

from rig.device import Sample
from zebro_lab.mcap.raw_log import RAW_SCHEMAS, decode_raw, encode_raw
from zebro_lab.recording.devices import profile_text
from zebro_lab.runs.profile_streams import profile_streams, stored_streams


def test_counts_of_an_imu_above_those_of_int32_are_logged(tmp_path):
    file = tmp_path / "imu.toml"
    text = profile_text("imu-quaternion-serial")
    file.write_text(text.replace("record = [", 'record = ["unused:uint32", '))
    schema = profile_streams(file)["imu"].schema
    counts = (2**32 - 1, 16384, *(0,) * 9)
    dtype, _ = RAW_SCHEMAS[schema]
    data = encode_raw([Sample(0.0, 0.0, 1, counts)], dtype=dtype, start=0.0)
    assert tuple(decode_raw(data, dtype=dtype).counts[0]) == counts


STREAMS = {
    ("legs", "zebro-100-serial"): {"legs"},
    ("imu2", "imu-quaternion-serial"): {"imu2"},
    ("rig", "rig-odrive-netft"): {"drives", "load_cell"},
    ("rig", "rig-board-serial"): {"board"},
}


@pytest.mark.parametrize("stored", STREAMS)
def test_each_stream_of_a_profile_names_its_counts_and_units(stored, tmp_path):
    name, profile = stored
    (tmp_path / "profiles").mkdir()
    file = tmp_path / "profiles" / f"{name}.toml"
    file.write_text(profile_text(profile))
    streams = profile_streams(file)
    assert set(streams) == STREAMS[stored]
    for stream in streams.values():
        assert stream.metadata["counts"]
        assert stream.metadata["unit"]
    assert stored_streams(tmp_path, [name]) == streams
