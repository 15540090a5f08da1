# SPDX-License-Identifier: MIT
"""One topic is read, and where that is a choice somebody makes it."""

import numpy as np
import pytest

from support.written_bags import BEGAN, imu, joints, write_bag
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.log_topics import read_topic

T = np.arange(0.0, 1.0, 0.1)
TYPES = ("sensor_msgs/msg/JointState",)


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bags") / "two"
    theta = np.ones((len(T), 6))
    return write_bag(
        folder, joints(T, theta, topic="/a"), joints(T[:4], 2 * theta[:4], topic="/b"), imu(T),
        storage="mcap",
    )  # fmt: skip


def test_the_only_topic_of_a_type_needs_no_choice(bag):
    found = read_topic(bag, ("sensor_msgs/msg/Imu",), what="IMU messages", topics=["/a"])
    assert (found.topic, found.type, len(found.contents)) == ("/imu", "sensor_msgs/msg/Imu", 10)
    np.testing.assert_allclose(found.t, BEGAN + T, atol=1e-6)
    assert found.notes == ()


@pytest.mark.parametrize("asked", [{"topic": "/b"}, {"topics": ["/imu", "/b"]}])
def test_a_topic_that_is_asked_for_is_read_and_the_others_are_named(bag, asked):
    found = read_topic(bag, TYPES, what="joint positions", **asked)
    assert (found.topic, len(found.t)) == ("/b", 4)
    assert found.notes == ("two: joint positions are taken from topic /b, not from /a",)


@pytest.mark.parametrize("topics", [(), ("/a", "/b"), ("/imu",)])
def test_several_topics_without_a_choice_are_refused(bag, topics):
    with pytest.raises(DataError, match=r"on the topics /a, /b; choose one with --topic NAME"):
        read_topic(bag, TYPES, what="joint positions", topics=topics)


def test_a_topic_that_is_not_there_is_refused_with_those_that_are(bag):
    with pytest.raises(DataError, match=r"has no joint positions on topic /c; .*known: '/a', '/b'"):
        read_topic(bag, TYPES, what="joint positions", topic="/c")
