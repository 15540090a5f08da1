# SPDX-License-Identifier: MIT
"""Logs with a few samples of each kind of device, and what public tools read in them."""

import io

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from rig.device import Counters, Sample
from rig.imu.profile import load_imu_profile
from rig.slip_rig.profile import load_rig_profile
from rig.zebro.profile import load_leg_profile
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.runs.profile_streams import imu_stream, legs_stream, rig_streams

START = 100.0
STREAMS = {
    "legs": legs_stream(load_leg_profile("zebro-100-serial")),
    "imu": imu_stream(load_imu_profile("imu-quaternion-serial")),
    **rig_streams(load_rig_profile("rig-odrive-netft")),
    **rig_streams(load_rig_profile("rig-board-serial")),
}
COUNTS = {
    "legs": (99, 1, 2, 3, 4, 5),
    "imu": (16384, 0, 0, 0, 90, 0, 0, 0, 0, 981),
    "drives": (1.25, 0.5),
    "load_cell": (1_000_000, 0, -6_000_000, 0, 0, 0),
    "board": (600_000, 100_000, 120_000, 30_000),
}


def log_of(stream, rows=3):
    """Return a log with a few samples of one stream, and the samples.

    Args:
        stream: Kind of stream.
        rows: Number of samples.
    """
    given_samples = [
        Sample(START + 0.01 * n, 0.01 * n, n, COUNTS[stream], 0, 1 if stream == "drives" else 0)
        for n in range(rows)
    ]
    file = io.BytesIO()
    writer = LogWriter(
        file, streams={stream: STREAMS[stream]}, attachments={"profiles/x.toml": "schema = 1"},
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


def events(folder, level=0):
    """Return the messages of topic `/events`, of a level or above, in the log of a run folder."""
    with (folder / "log.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        found = [d for *_, d in reader.iter_decoded_messages(topics=["/events"])]
    return [each.msg for each in found if each.level >= level]
