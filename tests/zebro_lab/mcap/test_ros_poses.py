# SPDX-License-Identifier: MIT
"""Frames, paths and poses are what the public ROS 2 decoder reads."""

import io

import numpy as np
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.ros_poses import (
    PATH,
    POSE,
    TRANSFORMS,
    Transform,
    path,
    pose_with_covariance,
    transforms,
)


def decoded(schema, message):
    file = io.BytesIO()
    log = MessageLog(file)
    log.register("/x", schema)
    log.add("/x", 1, message)
    log.finish()
    file.seek(0)
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    (found,) = [message for *_, message in reader.iter_decoded_messages()]
    return found


def xyz(vector):
    return vector.x, vector.y, vector.z


def test_frames_lie_in_their_parents():
    frames = [Transform("map", "body", (1.0, 2.0, 3.0), (0.0, 0.0, 0.6, 0.8)),
              Transform("body", "marker", (4.0, 5.0, 6.0), (0.0, 0.0, 0.0, 1.0))]  # fmt: skip
    found = decoded(TRANSFORMS, transforms(2_500_000_000, iter(frames))).transforms
    assert [(f.header.frame_id, f.child_frame_id) for f in found] == [
        ("map", "body"), ("body", "marker"),
    ]  # fmt: skip
    assert [xyz(f.transform.translation) for f in found] == [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0)]
    assert (found[0].transform.rotation.z, found[0].transform.rotation.w) == (0.6, 0.8)
    assert (found[0].header.stamp.sec, found[0].header.stamp.nanosec) == (2, 500_000_000)


def test_a_path_keeps_every_pose_and_its_time():
    positions, quaternions = np.arange(9.0).reshape(3, 3), np.tile([0.0, 0.0, 0.0, 1.0], (3, 1))
    stamps = [10**9, 2 * 10**9, 3 * 10**9]
    found = decoded(PATH, path(stamps, "map", positions, quaternions))
    assert found.header.stamp.sec == 1
    np.testing.assert_array_equal([xyz(p.pose.position) for p in found.poses], positions)
    assert [p.header.stamp.sec for p in found.poses] == [1, 2, 3]


def test_a_planar_covariance_fills_x_y_and_yaw_alone():
    covariance = np.array([[1.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 3.0]])
    found = decoded(POSE, pose_with_covariance(
        1, "map", position=np.arange(3.0), quaternion=np.array([0.0, 0.0, 0.0, 1.0]),
        covariance=covariance,
    ))  # fmt: skip
    whole = np.array(found.pose.covariance).reshape(6, 6)
    np.testing.assert_array_equal(whole[np.ix_((0, 1, 5), (0, 1, 5))], covariance)
    assert np.count_nonzero(whole) == 9
    assert xyz(found.pose.pose.position) == (0.0, 1.0, 2.0)
