# SPDX-License-Identifier: MIT
"""Messages are what the public ROS 2 decoder reads."""

import io
import math

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.ros_messages import (
    IMU,
    JOINT_STATE,
    LOG,
    WARNING,
    WRENCH,
    imu,
    joint_state,
    log_entry,
    wrench,
)

STAMP = 1_700_000_000_123_456_789


def decoded(schema, message):
    file = io.BytesIO()
    log = MessageLog(file)
    log.register("/x", schema)
    log.add("/x", STAMP, message)
    log.finish()
    file.seek(0)
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    (found,) = [message for *_, message in reader.iter_decoded_messages()]
    return found


def test_joints_have_names_and_the_sides_that_are_known():
    found = decoded(JOINT_STATE, joint_state(STAMP, ["a", "bc"], position=[1.0, -2.0]))
    assert (found.header.stamp.sec, found.header.stamp.nanosec) == (1_700_000_000, 123_456_789)
    assert (list(found.name), list(found.position)) == (["a", "bc"], [1.0, -2.0])
    assert list(found.velocity) == list(found.effort) == []


def test_a_wrench_has_traction_along_x_and_load_along_z():
    found = decoded(WRENCH, wrench(STAMP, normal=6.0, traction=-1.5)).wrench
    assert (found.force.x, found.force.z) == (-1.5, 6.0)
    assert math.isnan(found.force.y)
    assert math.isnan(found.torque.x)


def test_a_unit_has_orientation_rate_and_specific_force():
    found = decoded(IMU, imu(STAMP, orientation=[0.0, 0.6, 0.0, 0.8], angular_rate=[1.0, 2.0, 3.0],
                             specific_force=[4.0, 5.0, 6.0]))  # fmt: skip
    q, rate, force = found.orientation, found.angular_velocity, found.linear_acceleration
    assert (q.x, q.y, q.z, q.w) == (0.0, 0.6, 0.0, 0.8)
    assert (rate.x, rate.y, rate.z) == (1.0, 2.0, 3.0)
    assert (force.x, force.y, force.z) == (4.0, 5.0, 6.0)


def test_what_a_unit_does_not_measure_is_marked_as_ros_asks():
    nan = [math.nan] * 3
    for given in ({"angular_rate": nan}, {"specific_force": nan}, {"orientation": [math.nan] * 4}):
        whole = {"orientation": [0.0, 0.0, 0.0, 1.0], "angular_rate": [1.0, 2.0, math.nan],
                 "specific_force": [4.0, 5.0, 6.0]}  # fmt: skip
        found = decoded(IMU, imu(STAMP, **(whole | given)))
        firsts = {
            "orientation": found.orientation_covariance[0],
            "angular_rate": found.angular_velocity_covariance[0],
            "specific_force": found.linear_acceleration_covariance[0],
        }
        assert firsts == dict.fromkeys(firsts, 0.0) | dict.fromkeys(given, -1.0)


def test_an_event_has_its_level_and_text():
    found = decoded(LOG, log_entry(STAMP, "é", level=WARNING))
    assert (found.level, found.msg, found.name) == (WARNING, "é", "zebro_lab")
