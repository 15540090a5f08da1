# SPDX-License-Identifier: MIT
"""IMU messages of a ROS log are an IMU table without what they mark as not measured."""

import numpy as np
import pytest

from support.written_bags import imu, write_bag
from zebro_lab.exchange.imu_messages import read_imu_messages
from zebro_lab.files.errors import DataError

T = np.arange(0.0, 1.0, 0.1)


def test_orientation_rate_and_force_are_read(tmp_path):
    found = read_imu_messages(write_bag(tmp_path / "bag", imu(T), storage="mcap"))
    table = found.table
    assert found.topic == "/imu"
    assert table.notes == ("bag: topic /imu, sensor_msgs/msg/Imu, 10 messages",)
    np.testing.assert_allclose(table.numbers("qz"), np.sin(0.05 * T), atol=1e-12)
    np.testing.assert_allclose(table.numbers("qw"), np.cos(0.05 * T), atol=1e-12)
    assert set(table.numbers("rate_z")) == {0.1}
    assert set(table.numbers("force_z")) == {9.81}


def test_what_is_not_measured_has_no_column(tmp_path):
    absent = ("angular_velocity", "linear_acceleration")
    table = read_imu_messages(
        write_bag(tmp_path / "bag", imu(T, absent=absent), storage="mcap")
    ).table
    assert list(table.columns) == ["t", "qw", "qx", "qy", "qz"]


def test_messages_without_orientation_are_refused(tmp_path):
    bag = write_bag(tmp_path / "bag", imu(T, absent=("orientation",)), storage="mcap")
    with pytest.raises(DataError, match=r"has no orientation on topic /imu: .* covariance is -1"):
        read_imu_messages(bag)
