# SPDX-License-Identifier: MIT
"""Joint states of a ROS log are leg angles, by the names of the joints."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from mcap_ros2.writer import Writer

from zebro_lab.files.errors import DataError
from zebro_lab.robot.leg_log import ANGLES, LEG_UNITS
from zebro_lab.runs.joint_log import joined_readings, joint_table, legs_of_joints, read_joint_log
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable

HEADER = f"""\
{"=" * 80}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{"=" * 80}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
JOINT_STATE = f"""\
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
{HEADER}"""
Stamped = tuple[str, float, float, dict[str, float]]


def write(file: Path, *states: Stamped) -> Path:
    """Write joint states: topic, stamp [s], log time [s], position of each joint [rad]."""
    with file.open("wb") as out:
        writer = Writer(out)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE.strip())
        for topic, stamp, log_time, joints in states:
            seconds, rest = divmod(round(1e9 * stamp), 10**9)
            message = {
                "header": {"stamp": {"sec": seconds, "nanosec": rest}, "frame_id": ""},
                "name": [*joints], "position": [*joints.values()], "velocity": [], "effort": [],
            }  # fmt: skip
            writer.write_message(topic, schema, message, log_time=round(1e9 * log_time))
        writer.finish()
    return file


def test_joints_are_columns_by_their_stamps_and_names(tmp_path):
    first = ("/joints", 5.0, 9.0, {"leg_1": 0.1, "arm": 1.0, "t": 2.0})
    second = ("/joints", 5.5, 9.5, {"leg_1": 0.2})
    log = read_joint_log(write(tmp_path / "bag.mcap", first, second))
    assert list(log.table.columns) == ["t", "leg_1", "arm", "joint t"]
    np.testing.assert_allclose(log.table.numbers("t"), [5.0, 5.5])
    np.testing.assert_array_equal(log.table.numbers("leg_1"), [0.1, 0.2])
    np.testing.assert_array_equal(log.table.numbers("arm"), [1.0, np.nan])
    assert (log.legs, log.topic, log.table.notes) == ({"leg_1": 1}, "/joints", ())


def test_messages_without_a_stamp_have_the_time_of_the_log(tmp_path):
    log = read_joint_log(write(tmp_path / "bag.mcap", ("/joints", 0.0, 9.25, {"leg_1": 0.1})))
    np.testing.assert_allclose(log.table.numbers("t"), [9.25])


def test_one_topic_of_several_is_named(tmp_path):
    states = [(topic, 1.0, 1.0, {"leg_1": theta}) for topic, theta in (("/a", 0.1), ("/b", 0.2))]
    bag = write(tmp_path / "bag.mcap", *states, ("/empty", 1.0, 1.0, {}))
    with pytest.raises(DataError, match=r"joint positions on the topics /a, /b; choose one with"):
        read_joint_log(bag)
    table = read_joint_log(bag, topic="/b").table
    np.testing.assert_array_equal(table.numbers("leg_1"), [0.2])
    with pytest.raises(
        DataError, match=r"has no joint positions on topic /empty; known: '/a', '/b'"
    ):
        read_joint_log(bag, topic="/empty")


def test_a_log_without_positions_says_what_is_expected(tmp_path):
    bag = write(tmp_path / "bag.mcap", ("/joints", 1.0, 1.0, {}))
    with pytest.raises(
        DataError, match=r"holds no joint positions; expected .* of type control_msgs/msg"
    ):
        read_joint_log(bag)


def test_names_that_state_their_legs_are_columns_of_legs_and_told(tmp_path):
    joints = {"rr": 6.0, "lf": 1.0, "rf": 2.0, "lm": 3.0, "rm": 4.0, "lr": 5.0}
    log = read_joint_log(write(tmp_path / "bag.mcap", ("/joints", 1.0, 1.0, joints)))
    table = joint_table(log, Columns(LEG_UNITS))
    assert [table.numbers(name)[0] for name in ANGLES] == [1, 2, 3, 4, 5, 6]
    (note,) = table.notes
    assert note == "leg log: legs and their joints by name: 1 lf, 2 rf, 3 lm, 4 rm, 5 lr, 6 rr"


def test_messages_of_other_joints_on_the_topic_are_skipped(tmp_path):
    legs, arm = {f"leg_{leg}": 0.1 * leg for leg in range(1, 7)}, {"arm": 1.0}
    states = [("/joints", 1.0 + 0.1 * i, 1.0, (legs, arm)[i % 2]) for i in range(6)]
    table = joint_table(read_joint_log(write(tmp_path / "bag.mcap", *states)), Columns(LEG_UNITS))
    np.testing.assert_allclose(table.numbers("t"), [1.0, 1.2, 1.4])
    np.testing.assert_allclose(table.numbers("theta6"), 0.6)
    assert table.notes == ("bag.mcap: 3 of 6 messages have no leg's joint: skipped",)


def test_joints_are_never_legs_by_their_place_in_the_message(tmp_path):
    joints = {f"motor_{number}": 0.1 * number for number in range(6)}
    log = read_joint_log(write(tmp_path / "bag.mcap", ("/joints", 1.0, 1.0, joints)))
    columns = Columns(LEG_UNITS)
    with pytest.raises(DataError, match=r"has the joints motor_0, .* --joints A,B,C,D,E,F"):
        joint_table(log, columns)
    for leg, name in enumerate(ANGLES):
        columns = columns.called(name, f"motor_{5 - leg}")
    assert joint_table(log, columns).notes == ()


def test_messages_of_one_leg_each_are_joined_in_the_unit_of_the_columns(tmp_path):
    states = []
    for i in range(200):
        for leg in range(1, 7):
            t = 1 + 0.01 * i + 0.001 * leg
            states.append(("/joints", t, 1.0, {f"leg_{leg}": 200 * t % 360}))
    columns = Columns(LEG_UNITS)
    degrees = {name: replace(columns.mapped[name], unit="deg") for name in ANGLES}
    columns = replace(columns, columns=degrees)
    table = joint_table(read_joint_log(write(tmp_path / "bag.mcap", *states)), columns)
    t = table.numbers("t")
    for name in ANGLES:
        np.testing.assert_allclose((table.numbers(name) - 200 * t + 180) % 360, 180, atol=1e-4)
    assert "the other legs interpolated" in table.notes[0]


def a_topic_a_leg(topics):
    return [
        (topic, 1 + 0.01 * i + 0.001 * leg, 1.0, {f"leg_{leg}": 0.03 * i + 0.003 * leg})
        for i in range(20)
        for leg, topic in enumerate(topics, start=1)
    ]


def test_topics_of_one_leg_each_are_read_together(tmp_path):
    states = a_topic_a_leg([f"/leg{leg}/state" for leg in range(1, 7)])
    arm = [("/arm", 1 + 0.01 * i, 1.0, {"gripper": 0.1}) for i in range(20)]
    log = read_joint_log(write(tmp_path / "bag.mcap", *states, *arm))
    assert log.topic == ", ".join(f"/leg{leg}/state" for leg in range(1, 7))
    table = joint_table(log, Columns(LEG_UNITS))
    for name in ANGLES:
        np.testing.assert_allclose(table.numbers(name), 3 * (table.numbers("t") - 1), atol=1e-6)


def test_topics_that_share_a_leg_or_lack_one_are_not_mixed(tmp_path):
    topics = [f"/leg{leg}" for leg in range(1, 7)]
    again = [("/copy", 1.0, 1.0, {"leg_3": 0.1})]
    for states in (a_topic_a_leg(topics[:5]), [*a_topic_a_leg(topics), *again]):
        with pytest.raises(DataError, match=r"joint positions on the topics .*; choose one with"):
            read_joint_log(write(tmp_path / "bag.mcap", *states))


DYNAMIC = f"""
std_msgs/Header header
string[] joint_names
control_msgs/InterfaceValue[] interface_values
{HEADER}{"=" * 80}
MSG: control_msgs/InterfaceValue
string[] interface_names
float64[] values
"""


def test_positions_of_dynamic_joint_states_are_read(tmp_path):
    with (tmp_path / "bag.mcap").open("wb") as out:
        writer = Writer(out)
        schema = writer.register_msgdef("control_msgs/msg/DynamicJointState", DYNAMIC.strip())
        for i in range(3):
            values = [
                {"interface_names": ["velocity", "position"], "values": [9.0, 0.1 * i + leg]}
                for leg in range(1, 7)
            ]
            message = {
                "header": {"stamp": {"sec": 5, "nanosec": i * 10**8}, "frame_id": ""},
                "joint_names": ["arm", *(f"leg_{leg}" for leg in range(1, 7))],
                "interface_values": [{"interface_names": ["effort"], "values": [1.0]}, *values],
            }
            writer.write_message("/dynamic_joint_states", schema, message, log_time=i)
        writer.finish()
    log = read_joint_log(tmp_path / "bag.mcap")
    assert log.joints == tuple(f"leg_{leg}" for leg in range(1, 7))
    np.testing.assert_allclose(log.table.numbers("t"), [5.0, 5.1, 5.2])
    np.testing.assert_allclose(log.table.numbers("leg_4"), [4.0, 4.1, 4.2])


SIDES = ("left", "right")
NAMES = {
    "numbers": [f"leg_{leg}" for leg in range(1, 7)],
    "numbers within": [f"base_leg{leg}_joint" for leg in range(1, 7)],
    "words": [f"leg_{row}_{side}_joint" for row in ("front", "middle", "rear") for side in SIDES],
    "side first": [f"{side}_{row}" for row in ("fore", "mid", "hind") for side in SIDES],
    "humps": ["frontLeftHip", "frontRightHip", "centerLeftHip", "centerRightHip", "backLeftHip",
              "backRightHip"],
    "short": [f"{each}_hip" for each in ("FL", "FR", "ML", "MR", "RL", "RR")],
    "short, side first": ["lf", "rf", "lm", "rm", "lr", "rr"],
    "back": ["motor_lb", "motor_rb"],
}  # fmt: skip


@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES)
def test_names_state_their_legs_in_any_order(names):
    first = 5 if names[0] == "motor_lb" else 1
    expected = {name: leg for leg, name in enumerate(names, first)}
    assert legs_of_joints(names) == expected
    assert legs_of_joints([*reversed(names), "gripper"]) == expected


@pytest.mark.parametrize(
    "name", ["leg_0", "leg_7", "leg12", "motor_3", "left", "wheel_left", "", "lr_fl"]
)
def test_other_names_state_nothing(name):
    assert legs_of_joints([name]) == {}


def test_two_joints_of_a_leg_state_nothing():
    """Which of them turns the leg is not to be told from names."""
    assert legs_of_joints(["leg_1_coxa", "leg_1_femur", "leg_2_coxa"]) == {}
    assert legs_of_joints([f"leg_{number}" for number in range(6)] + ["lf"]) == {}


SPEED = 3.0  # rad/s


def messages(rate=100.0, lag=0.0015, seconds=3.0, group=1, turn=None, speed=SPEED):
    """Return a table with a message for each `group` of legs, `lag` s after the one before."""
    rows = []
    for t in np.arange(0, seconds, 1 / rate):
        for first in range(0, 6, group):
            at = t + lag * (first // group)
            angle = speed * at if turn is None else (speed * at) % turn
            rows.append({"t": at, **dict.fromkeys(ANGLES[first : first + group], angle)})
    return pd.DataFrame(rows, columns=["t", *ANGLES])


def joined(frame, turn=2 * np.pi):
    columns = {name: frame[name].reset_index(drop=True) for name in frame}
    return joined_readings(RawTable(Path("bag.mcap"), columns), dict.fromkeys(ANGLES, turn))


@pytest.mark.parametrize("group", [1, 2, 3])
def test_every_leg_is_where_it_was_at_the_time_of_the_row(group):
    table = joined(messages(group=group))
    t = table.columns["t"].to_numpy()
    assert len(t) == 299  # the first time of the first leg is before all others
    for name in ANGLES:
        np.testing.assert_allclose(table.columns[name], SPEED * t, atol=1e-12)
    (note,) = table.notes
    assert "joined at the 299 times of theta1, the other legs interpolated" in note


@pytest.mark.parametrize("turn", [2 * np.pi, 360.0])
def test_wrapped_legs_are_not_interpolated_across_a_turn(turn):
    speed = SPEED * turn / (2 * np.pi)
    table = joined(messages(turn=turn, speed=speed), turn=turn)
    t = table.columns["t"].to_numpy()
    for name in ANGLES:
        np.testing.assert_allclose(np.unwrap(table.columns[name], period=turn), speed * t)


def test_a_wrapped_leg_whose_direction_is_ambiguous_is_refused():
    with pytest.raises(DataError, match="theta1 turns by more than a quarter between two"):
        joined(messages(rate=5.0, turn=2 * np.pi, speed=9.0))


def test_rows_have_the_times_of_the_leg_with_the_fewest_readings():
    frame = messages()
    fewer = frame[frame.theta4.isna() | (frame.index // 6 % 2 == 1)]
    table = joined(fewer)
    seen = fewer.t[fewer.theta4.notna()]
    np.testing.assert_allclose(table.columns["t"], seen[:-1])  # the last is after other legs' last
    np.testing.assert_allclose(table.columns["theta2"], SPEED * table.columns["t"])


def test_nothing_is_extrapolated():
    frame = messages()
    late = frame[frame.theta2.isna() | ((frame.t > 1.0) & (frame.t < 2.0))]
    t = joined(late).columns["t"].to_numpy()
    seen = late.t[late.theta2.notna()]
    assert seen.min() <= t[0] < t[-1] <= seen.max()


def test_a_gap_of_one_leg_is_refused_with_its_place():
    frame = messages()
    silent = frame[frame.theta3.isna() | (frame.t < 0.5) | (frame.t > 0.6)]
    expected = r"theta3 has no reading for 0\.11 s, from 0\.49\d s after its first; expected .* cut"
    with pytest.raises(DataError, match=expected):
        joined(silent)


def test_stamps_that_go_back_are_refused():
    frame = messages()
    frame.loc[61, "t"] -= 0.5
    with pytest.raises(DataError, match="the stamps of theta2 do not increase"):
        joined(frame)


def test_a_table_with_a_row_of_all_legs_is_left_as_it_is():
    frame = messages(group=6)
    frame.loc[5, "theta3"] = np.nan
    table = joined(frame)
    assert len(table.columns["t"]) == len(frame)
    assert np.isnan(table.columns["theta3"][5])
