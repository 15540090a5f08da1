# SPDX-License-Identifier: MIT
"""Messages of registered topics, numbered by topic, in a file that every MCAP reader knows."""

import io

import pytest
from mcap.reader import make_reader

from zebro_lab.mcap.message_log import MessageLog
from zebro_lab.mcap.ros_messages import LOG, WRENCH, log_entry, wrench


def written(fill):
    file = io.BytesIO()
    log = MessageLog(file)
    fill(log)
    log.finish()
    file.seek(0)
    return make_reader(file)


def test_messages_come_back_by_topic_numbered_from_0():
    def fill(log):
        for topic in ("/a", "/b"):
            log.register(topic, LOG)
        for stamp in (10, 20, 30):
            log.add("/a", stamp, log_entry(stamp, "x"))
        log.add("/b", 40, log_entry(40, "y"))

    messages = list(written(fill).iter_messages())
    assert [(c.topic, m.sequence, m.log_time, m.publish_time) for _, c, m in messages] == [
        ("/a", 0, 10, 10), ("/a", 1, 20, 20), ("/a", 2, 30, 30), ("/b", 0, 40, 40),
    ]  # fmt: skip
    assert messages[0][2].data == log_entry(10, "x")


def test_topics_of_one_type_share_its_schema_and_keep_their_metadata():
    def fill(log):
        log.register("/a", LOG, metadata={"unit": "N"})
        log.register("/b", LOG)
        log.register("/c", WRENCH)
        log.add("/c", 1, wrench(1, normal=1.0, traction=2.0))

    summary = written(fill).get_summary()
    assert sorted(schema.name for schema in summary.schemas.values()) == sorted(
        [LOG.name, WRENCH.name]
    )
    channels = {channel.topic: channel for channel in summary.channels.values()}
    assert channels["/a"].schema_id == channels["/b"].schema_id
    assert channels["/a"].metadata == {"unit": "N"}


def test_texts_and_names_are_kept_beside_the_messages():
    def fill(log):
        log.attach(5, "x.toml", "application/toml", "schema = 1")
        log.describe("run", {"label": "a"})

    reader = written(fill)
    (attachment,) = reader.iter_attachments()
    assert (attachment.name, attachment.data) == ("x.toml", b"schema = 1")
    (record,) = reader.iter_metadata()
    assert (record.name, record.metadata) == ("run", {"label": "a"})


def test_a_flushed_log_can_be_read_before_its_end():
    file = io.BytesIO()
    log = MessageLog(file)
    log.register("/a", LOG)
    log.add("/a", 1, log_entry(1, "x" * 50))
    before = len(file.getvalue())
    log.flush()
    assert len(file.getvalue()) > before


def test_a_topic_that_was_not_registered_is_an_error():
    with pytest.raises(KeyError):
        MessageLog(io.BytesIO()).add("/a", 1, b"")
