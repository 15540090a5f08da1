# SPDX-License-Identifier: MIT
"""A table of messages says which topic they are from."""

from pathlib import Path

import numpy as np

from zebro_lab.exchange.topic_table import TopicTable
from zebro_lab.mcap.log_topics import TopicRows


def test_topic_type_and_count_are_told_before_the_notes_of_reading():
    rows = TopicRows("/a", "x/msg/Y", (0.0, 1.0), (None, None), ("cut short",))
    made = TopicTable.of(Path("b/walk.mcap"), {"t": np.arange(2.0)}, rows)
    assert made.topic == "/a"
    assert made.table.notes == ("walk.mcap: topic /a, x/msg/Y, 2 messages", "cut short")
    np.testing.assert_array_equal(made.table.numbers("t"), [0.0, 1.0])
