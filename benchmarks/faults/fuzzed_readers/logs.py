# SPDX-License-Identifier: MIT
"""Readers of MCAP."""

import io
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from benchmarks.faults.fuzzed_readers.reader import Reader, mcap_check
from benchmarks.faults.hostile_inputs import (
    Make,
    pick,
    pool,
)
from rig.device import Sample
from rig.zebro.profile import load_leg_profile
from zebro_lab.mcap.cdr import CdrWriter
from zebro_lab.mcap.log_writer import LogWriter
from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.raw_log import read_raw_log
from zebro_lab.mcap.ros_log import read_messages
from zebro_lab.mcap.ros_messages import Schema, joint_state
from zebro_lab.mcap.slip_rig_log import SCHEMA_NAME, SCHEMA_TEXT, TOPIC, read_log
from zebro_lab.mcap.stream_views import legs_view
from zebro_lab.runs.legs import read_leg_log


def of_logs() -> Mapping[str, Reader]:
    """Return readers of MCAP."""
    recorded, rig = _recorded(), io.BytesIO()
    t = np.arange(200) / 100
    earlier, message = MessageLog(rig), CdrWriter()
    earlier.register(TOPIC, Schema(SCHEMA_NAME, SCHEMA_TEXT))
    for _ in range(5):
        message.array(t)
    earlier.add(TOPIC, 10**18, message.message())
    earlier.finish()
    log = "rcl_interfaces/msg/Log"
    raw, samples, joints = _logs([recorded]), _logs([rig.getvalue()]), _bag()
    return {
        "log.mcap, raw": Reader("log.mcap", read_raw_log, raw, mcap_check),
        "log.mcap, rig": Reader("log.mcap", read_log, samples, mcap_check),
        "log.mcap, ROS 2": Reader("log.mcap", lambda f: read_messages(f, schema=log), raw,
                                  mcap_check),
        "bag of ROS 2, legs": Reader("log.db3", read_leg_log, pool([joints]), _bag_check, 10_000),
    }  # fmt: skip


def _bag() -> bytes:
    """Make a bag of joint states in SQLite."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    kind, store = "sensor_msgs/msg/JointState", get_typestore(Stores.ROS2_HUMBLE)
    names = [f"leg_{leg}" for leg in range(1, 7)]
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "bag"
        with Writer(bag, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
            connection = writer.add_connection("/joints", kind, typestore=store)
            for n in range(50):
                message = joint_state(10**18 + n * 10**7, names, position=[0.1 * n] * 6)
                writer.write(connection, 10**18 + n * 10**7, message)
        return (bag / "bag.db3").read_bytes()


def _bag_check(data: bytes) -> None:
    """Read the magic of SQLite."""
    if not data.startswith(b"SQLite format 3"):
        raise ValueError("no SQLite")


def _recorded() -> bytes:
    profile, out = load_leg_profile("zebro-100-serial"), io.BytesIO()
    writer = LogWriter(
        out, views={"legs": legs_view("legs", profile=profile)},
        attachments={"profiles/legs.toml": "x = 1"}, start=0.0, start_ns=10**18,
    )  # fmt: skip
    writer.event(0.0, "began")
    samples = [Sample(0.01 * n, 0.01 * n, n, tuple(range(n, n + 6))) for n in range(60)]
    for first in range(0, 60, 20):
        writer.write("legs", samples[first : first + 20])
        writer.flush()
    writer.finish()
    return out.getvalue()


def _logs(made: list[bytes]) -> Make:
    """Make logs whose records, inside chunks too, were changed, with sums that are right."""
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader, get_chunk_data_stream

    magic = b"\x89MCAP0\r\n"
    parsed = [list(StreamReader(io.BytesIO(data), emit_chunks=True).records) for data in made]
    inner = [
        get_chunk_data_stream(record)[0]._stream.getvalue()  # pyright: ignore[reportAttributeAccessIssue]
        for records in parsed for record in records if isinstance(record, Chunk)
    ]  # fmt: skip
    whole = pool(made)

    def make(rng: np.random.Generator) -> bytes:
        if rng.random() < 0.4:
            return whole(rng)
        parts = [magic]
        for data in inner:
            body = pool([data], 0.7)(rng)
            size = pick(rng, (len(body),) * 8 + (0, 1 << 40))
            chunk = bytes(16) + size.to_bytes(8, "little") + bytes(4) + (0).to_bytes(4, "little")
            chunk += len(body).to_bytes(8, "little") + body
            parts.append(b"\x06" + len(chunk).to_bytes(8, "little") + chunk)
        return b"".join(parts)

    return make
