# SPDX-License-Identifier: MIT
"""Poses of a ROS log are those of a track, whatever message holds them, in the plane asked for."""

import numpy as np
import pytest

from support.written_bags import BEGAN, joints, odometry, stamped, transforms, write_bag
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.tables.columns import Columns
from zebro_lab.track.foreign import ForeignTrack, read_foreign_track
from zebro_lab.track.trajectory.request import Axis, Plane, TrajectoryRequest
from zebro_lab.track.trajectory.table import MAPPED_UNITS

T = np.arange(0.0, 8.0, 0.1)
PATH = np.column_stack([0.1 * T, 0.05 * T**2, T])  # yaw passes half a turn


def read(bag, *, topics=(), **how) -> ForeignTrack:
    mapping = Columns(MAPPED_UNITS)
    return read_foreign_track(bag, mapping, TrajectoryRequest(**how), topics=topics)


def expect(found: ForeignTrack, *, path=PATH) -> None:
    np.testing.assert_allclose(found.track.poses.t, BEGAN + T, atol=1e-6)
    np.testing.assert_allclose(found.track.poses.states, path, atol=1e-9)


@pytest.mark.parametrize("written", [odometry, stamped])
def test_odometry_and_stamped_poses_are_read(written, tmp_path):
    found = read(write_bag(tmp_path / "bag", written(T, PATH), storage="mcap"))
    expect(found)
    np.testing.assert_allclose(found.columns["z_m"], 0.06)
    assert "cov_xx" not in found.columns  # zeros: unknown


COVARIANCE = 1e-4 * (np.diag(np.arange(2.0, 8.0)) + 0.5)


@pytest.mark.parametrize(
    ("plane", "kept", "signs"),
    [("xy", (0, 1, 5), (1, 1, 1)), ("yx", (1, 0, 5), (1, 1, -1)), ("zx", (2, 0, 4), (1, 1, 1)),
     ("xz", (0, 2, 4), (1, 1, -1))],
)  # fmt: skip
def test_the_planar_part_of_a_covariance_is_kept(plane, kept, signs, tmp_path):
    messages = odometry(T, PATH, covariance=COVARIANCE)
    bag = write_bag(tmp_path / "bag", messages, storage="mcap")
    found = read(bag, plane=Plane(plane))
    expected = COVARIANCE[np.ix_(kept, kept)] * np.outer(signs, signs)
    np.testing.assert_allclose(found.track.covariance, np.broadcast_to(expected, (len(T), 3, 3)))


def test_a_path_is_read_in_the_plane_that_is_asked_for(tmp_path):
    bag = write_bag(tmp_path / "bag", odometry(T, PATH), storage="mcap")
    x, y, yaw = PATH.T
    expect(read(bag, plane=Plane.YX, forward=Axis.Y), path=np.column_stack([y, x, -yaw]))
    across = read(bag, plane=Plane.XZ)  # asked for, so no question
    np.testing.assert_allclose(across.track.poses.position, np.column_stack([x, 0 * x + 0.06]))


def test_a_path_across_the_plane_is_asked_about(tmp_path):
    upright = [(topic, at, kind, message) for topic, at, kind, message in odometry(T, PATH)]
    for (*_, message), height in zip(upright, PATH[:, 1], strict=True):
        message.pose.pose.position.y, message.pose.pose.position.z = 0.0, height
    bag = write_bag(tmp_path / "bag", upright, storage="mcap")
    with pytest.raises(SettingsError, match=r"--plane: .*bag extends farther across the plane xy"):
        read(bag)
    np.testing.assert_allclose(read(bag, plane=Plane.XZ).track.poses.position, PATH[:, :2])


def test_a_transform_is_chosen_by_its_child_frame(tmp_path):
    frames = transforms(T, {"base_link": PATH, "camera": 2 * PATH})
    bag = write_bag(tmp_path / "bag", frames, joints(T, np.zeros((len(T), 6))), storage="mcap")
    with pytest.raises(DataError, match=r"poses on the topics /tf:base_link, /tf:camera; choose"):
        read(bag)
    found = read(bag, topics=["/joint_states", "/tf:base_link"])
    expect(found)
    assert found.topic == "/tf:base_link"
    assert found.track.notes[0] == "bag: topic /tf:base_link, tf2_msgs/msg/TFMessage, 80 messages"


def test_quaternions_of_zeros_are_no_yaw_but_a_single_one_is_a_fault(tmp_path):
    places = PATH.copy()
    places[3, 2] = np.nan
    with pytest.raises(DataError, match=r"row 4: the quaternion has length 0; expected 1 within"):
        read(write_bag(tmp_path / "one", odometry(T, places), storage="mcap"))
    places[:, 2] = np.nan
    found = read(write_bag(tmp_path / "all", odometry(T, places), storage="mcap"))
    assert set(found.columns) == {"t_s", "x_m", "y_m", "z_m"}


def test_static_transforms_are_no_paths(tmp_path):
    mounted = transforms(T[:1], {"camera": PATH[:1], "lidar": PATH[:1]}, topic="/tf_static")
    bag = write_bag(tmp_path / "bag", mounted, transforms(T, {"base_link": PATH}))
    found = read(bag)
    expect(found)
    assert "tf_static" not in " ".join(found.track.notes)
