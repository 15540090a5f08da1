# SPDX-License-Identifier: MIT
"""Joint states of a ROS 2 log are leg angles."""

from pathlib import Path

import numpy as np
import pytest

from support.imported_files import everything, taken
from zebro_lab.exchange.joint_log import read_joint_log
from zebro_lab.files.errors import DataError
from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.ros_messages import JOINT_STATE, joint_state
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import read_manifest


def test_a_ros_log_of_joint_states_is_a_leg_log(files, tmp_path):
    folder, _ = everything(files, tmp_path)
    imported = taken(tmp_path, legs=folder / "log.mcap", label="again")
    again = read_manifest(imported.folders[0])
    assert again.start == "2026-03-04T05:06:07+00:00"  # its stamps are seconds since 1970
    assert again.source == "import:log.mcap"
    ours, theirs = (read_leg_log(f).reference for f in (folder, imported.folders[0]))
    np.testing.assert_allclose(theirs.t, ours.t - ours.t[0], atol=1e-6)
    np.testing.assert_allclose(theirs.theta, ours.theta, atol=1e-9)


def test_a_log_without_leg_angles_is_refused(files, tmp_path):
    (files / "noise.mcap").write_bytes(b"\x00" * 500)
    with pytest.raises(DataError, match="not an MCAP"):
        taken(tmp_path, legs=files / "noise.mcap")
    folder, _ = everything(files, tmp_path)
    (files / "named.toml").write_text('[legs]\ntopic = "/joints"')
    with pytest.raises(DataError, match="/legs/joint_states"):
        taken(tmp_path, legs=folder / "log.mcap", columns=files / "named.toml")


Stamped = tuple[str, float, float, dict[str, float]]


def write(file: Path, *states: Stamped) -> Path:
    """Write joint states: topic, stamp [s], log time [s], position of each joint [rad]."""
    with file.open("wb") as out:
        log = MessageLog(out)
        for topic in dict.fromkeys(state[0] for state in states):
            log.register(topic, JOINT_STATE)
        for topic, stamp, log_time, joints in states:
            message = joint_state(round(1e9 * stamp), [*joints], position=[*joints.values()])
            log.add(topic, round(1e9 * log_time), message)
        log.finish()
    return file


def test_joints_are_columns_by_their_stamps_and_legs_have_canonical_names(tmp_path):
    first = ("/joints", 5.0, 9.0, {"leg_1": 0.1, "arm": 1.0})
    second = ("/joints", 5.5, 9.5, {"leg_1": 0.2})
    table = read_joint_log(write(tmp_path / "bag.mcap", first, second))
    assert list(table.columns) == ["t", "theta1", "arm"]
    np.testing.assert_allclose(table.numbers("t"), [5.0, 5.5])
    np.testing.assert_array_equal(table.numbers("theta1"), [0.1, 0.2])
    np.testing.assert_array_equal(table.numbers("arm"), [1.0, np.nan])
    assert table.notes == ()


def test_messages_without_a_stamp_have_the_time_of_the_log(tmp_path):
    table = read_joint_log(write(tmp_path / "bag.mcap", ("/joints", 0.0, 9.25, {"leg_1": 0.1})))
    np.testing.assert_allclose(table.numbers("t"), [9.25])


def test_one_topic_of_several_is_named(tmp_path):
    states = [(topic, 1.0, 1.0, {"leg_1": theta}) for topic, theta in (("/a", 0.1), ("/b", 0.2))]
    bag = write(tmp_path / "bag.mcap", *states, ("/empty", 1.0, 1.0, {}))
    with pytest.raises(
        DataError, match=r"has joint states of the topics /a, /b; choose one with topic ="
    ):
        read_joint_log(bag)
    np.testing.assert_array_equal(read_joint_log(bag, topic="/b").numbers("theta1"), [0.2])
    with pytest.raises(
        DataError, match=r"has no joint positions on topic /empty; known: '/a', '/b'"
    ):
        read_joint_log(bag, topic="/empty")


def test_a_log_without_positions_says_what_is_expected(tmp_path):
    bag = write(tmp_path / "bag.mcap", ("/joints", 1.0, 1.0, {}))
    with pytest.raises(
        DataError, match=r"holds no joint positions; expected .* of type sensor_msgs/msg"
    ):
        read_joint_log(bag)
