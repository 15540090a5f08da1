# SPDX-License-Identifier: MIT
import pytest
from mcap.writer import Writer

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


def test_a_whole_log_gives_its_messages(tmp_path):
    messages, damage = read_messages(log_of(tmp_path / "log.mcap", LOG_TEXT), schema=LOG)
    assert [message.topic for message in messages] == ["/events"]
    assert damage is None


@pytest.mark.parametrize(
    ("whole", "damaged"),
    [("Time stamp", "Time_stamp"), ("uint8 level", "uint8 LEVEL"), ("uint8 level", "wstring level"),
     ("string name", "string[ name"), ("uint32 line", "uint33 line"), ("MSG: ", "MSG ")],
)  # fmt: skip
def test_a_damaged_description_is_damage_and_says_of_what(tmp_path, whole, damaged):
    assert whole in LOG_TEXT
    path = log_of(tmp_path / "log.mcap", LOG_TEXT.replace(whole, damaged, 1))
    messages, damage = read_messages(path, schema=LOG)
    assert messages == []
    assert LOG in damage or "/events" in damage


def test_a_message_cut_short_is_damage(tmp_path):
    path = log_of(tmp_path / "log.mcap", LOG_TEXT, data=b"\0\1\0\0")
    messages, damage = read_messages(path, schema=LOG)
    assert (messages, "a message of /events" in damage) == ([], True)
