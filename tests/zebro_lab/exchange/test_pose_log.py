# SPDX-License-Identifier: MIT
"""Poses of a ROS log are the columns of a track, whatever message holds them."""

import numpy as np
import pytest

from support.written_bags import BEGAN, joints, odometry, stamped, transforms, write_bag
from zebro_lab.exchange.pose_log import read_pose_log
from zebro_lab.files.errors import DataError

T = np.arange(0.0, 8.0, 0.1)
PATH = np.column_stack([0.1 * T, 0.05 * T**2, T])  # yaw passes half a turn


def expect(table, *, path=PATH) -> None:
    np.testing.assert_allclose(table.numbers("t_s"), BEGAN + T, atol=1e-6)
    found = np.column_stack([table.numbers(name) for name in ("x_m", "y_m", "yaw_rad")])
    np.testing.assert_allclose(found, path, atol=1e-9)


@pytest.mark.parametrize("written", [odometry, stamped])
def test_odometry_and_stamped_poses_are_read(written, tmp_path):
    found = read_pose_log(write_bag(tmp_path / "bag", written(T, PATH), storage="mcap"))
    expect(found.table)
    np.testing.assert_allclose(found.table.numbers("z_m"), 0.06)
    assert "cov_xx" not in found.table.columns  # zeros: unknown


def test_the_planar_part_of_a_covariance_is_kept(tmp_path):
    covariance = np.arange(36.0).reshape(6, 6)
    bag = write_bag(tmp_path / "bag", odometry(T, PATH, covariance=covariance), storage="mcap")
    table = read_pose_log(bag).table
    for name, index in {"xx": (0, 0), "xy": (0, 1), "xyaw": (0, 5), "yy": (1, 1), "yyaw": (1, 5),
                        "yawyaw": (5, 5)}.items():  # fmt: skip
        assert set(table.numbers(f"cov_{name}")) == {covariance[index]}


def test_a_transform_is_chosen_by_its_child_frame(tmp_path):
    frames = transforms(T, {"base_link": PATH, "camera": 2 * PATH})
    bag = write_bag(tmp_path / "bag", frames, joints(T, np.zeros((len(T), 6))), storage="mcap")
    with pytest.raises(DataError, match=r"poses on the topics /tf:base_link, /tf:camera; choose"):
        read_pose_log(bag)
    found = read_pose_log(bag, topics=["/joint_states", "/tf:base_link"])
    expect(found.table)
    assert found.topic == "/tf:base_link"
    assert found.table.notes[0] == "bag: topic /tf:base_link, tf2_msgs/msg/TFMessage, 80 messages"


def test_quaternions_of_zeros_are_no_yaw_but_a_single_one_is_a_fault(tmp_path):
    places = PATH.copy()
    places[3, 2] = np.nan
    with pytest.raises(DataError, match=r"quaternion of message 4 on topic /odom has length 0"):
        read_pose_log(write_bag(tmp_path / "one", odometry(T, places), storage="mcap"))
    places[:, 2] = np.nan
    table = read_pose_log(write_bag(tmp_path / "all", odometry(T, places), storage="mcap")).table
    assert list(table.columns) == ["t_s", "x_m", "y_m", "z_m"]


def test_static_transforms_are_no_paths(tmp_path):
    mounted = transforms(T[:1], {"camera": PATH[:1], "lidar": PATH[:1]}, topic="/tf_static")
    bag = write_bag(tmp_path / "bag", mounted, transforms(T, {"base_link": PATH}))
    found = read_pose_log(bag)
    expect(found.table)
    assert "tf_static" not in " ".join(found.table.notes)


def test_of_many_topics_the_first_are_listed(tmp_path):
    bag = write_bag(tmp_path / "bag", transforms(T, {f"wheel_{i:02}": PATH for i in range(15)}))
    with pytest.raises(DataError, match=r"/tf:wheel_11 and 3 more; choose one with --topic"):
        read_pose_log(bag)
