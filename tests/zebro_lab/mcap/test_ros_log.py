# SPDX-License-Identifier: MIT
"""Logs of ROS are read but for their damage, bags up to it; both say what they need."""

import sys

import numpy as np
import pytest
from mcap.writer import Writer

from support.written_bags import BEGAN, imu, joints, write_bag, write_ros1_bag
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.names import is_ros_log
from zebro_lab.mcap.log_writer import LOG, LOG_TEXT
from zebro_lab.mcap.ros_log import read_messages


def log_of(path, text, data=b"\0\1\0\0" + bytes(64)):
    """Write a log of one message by hand, described as told."""
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        schema = writer.register_schema(LOG, "ros2msg", text.encode())
        channel = writer.register_channel("/events", "cdr", schema)
        writer.add_message(channel, log_time=0, data=data, publish_time=0)
        writer.finish()
    return path


@pytest.mark.parametrize(
    ("whole", "damaged"),
    [("Time stamp", "Time_stamp"), ("uint8 level", "uint8 LEVEL"), ("uint8 level", "wstring level"),
     ("string name", "string[ name"), ("uint32 line", "uint33 line"), ("MSG: ", "MSG ")],
)  # fmt: skip
def test_a_damaged_description_is_damage_and_says_of_what(tmp_path, whole, damaged):
    assert whole in LOG_TEXT
    path = log_of(tmp_path / "log.mcap", LOG_TEXT.replace(whole, damaged, 1))
    messages, damage = read_messages(path, (LOG,))
    assert messages == []
    assert LOG in damage or "/events" in damage


def test_a_message_cut_short_is_damage(tmp_path):
    path = log_of(tmp_path / "log.mcap", LOG_TEXT, data=b"\0\1\0\0")
    messages, damage = read_messages(path, (LOG,))
    assert (messages, "a message of /events" in damage) == ([], True)


JOINTS = ("sensor_msgs/msg/JointState",)
T = np.arange(0.0, 1.0, 0.1)
THETA = T[:, None] + np.arange(6)


@pytest.fixture
def bag(tmp_path):
    return write_bag(tmp_path / "walk", joints(T, THETA), imu(T))


def positions(messages) -> np.ndarray:
    return np.array([message.content.position for message in messages])


@pytest.mark.parametrize("part", ["", "walk.db3"])
def test_a_bag_is_read_from_its_folder_and_from_its_file_alone(bag, part):
    messages, damage = read_messages(bag / part, JOINTS)
    assert damage is None
    np.testing.assert_array_equal(positions(messages), THETA)
    np.testing.assert_allclose([m.log_time / 1e9 for m in messages], BEGAN + T)
    assert {(m.topic, m.type) for m in messages} == {
        ("/joint_states", "sensor_msgs/msg/JointState")
    }
    assert read_messages(bag / part, ("nav_msgs/msg/Odometry",)) == ([], None)


def test_a_bag_that_was_copied_without_its_metadata_says_so(bag):
    (bag / "metadata.yaml").unlink()
    assert is_ros_log(bag)
    with pytest.raises(
        NotFound, match=r"walk: metadata.yaml of the bag is missing; copy .*reindex"
    ):
        read_messages(bag, JOINTS)


def test_a_ros_1_bag_is_read_too(tmp_path):
    file = write_ros1_bag(tmp_path / "walk.bag", joints(T, THETA))
    messages, damage = read_messages(file, JOINTS)
    assert damage is None
    np.testing.assert_array_equal(positions(messages), THETA)


def test_a_folder_of_mcap_logs_needs_no_package(tmp_path, monkeypatch):
    folder = write_bag(tmp_path / "walk", joints(T, THETA), storage="mcap")
    monkeypatch.setitem(sys.modules, "rosbags.highlevel", None)
    messages, _ = read_messages(folder, JOINTS)
    np.testing.assert_array_equal(positions(messages), THETA)


def test_a_missing_package_is_named_with_the_way_to_install_it(bag, monkeypatch):
    monkeypatch.setitem(sys.modules, "rosbags.highlevel", None)
    with pytest.raises(NotFound, match=r"pip install rosbags"):
        read_messages(bag, JOINTS)


@pytest.mark.parametrize("noise", [b"", b"\0" * 5000, b"SQLite format 3\0" + b"\1" * 5000])
def test_what_is_no_bag_is_one_line(tmp_path, noise):
    for name in ("x.db3", "x.bag"):
        (tmp_path / name).write_bytes(noise)
        with pytest.raises(DataError, match="cannot be read as a ROS bag") as caught:
            read_messages(tmp_path / name, JOINTS)
        assert "\n" not in str(caught.value)


def test_a_message_that_cannot_be_decoded_ends_the_reading(tmp_path):
    import sqlite3

    bag = write_bag(tmp_path / "walk", joints(T, THETA))
    with sqlite3.connect(bag / "walk.db3") as database:
        database.execute("UPDATE messages SET data = x'00010000' WHERE id = 4")
    database.close()
    messages, damage = read_messages(bag, JOINTS)
    assert (len(messages), damage is None) == (3, False)
