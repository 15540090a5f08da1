# SPDX-License-Identifier: MIT
"""A table made of the messages of one topic."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from model.arrays import Array
from zebro_lab.mcap.log_topics import TopicRows
from zebro_lab.tables.raw_table import RawTable


@dataclass(frozen=True)
class TopicTable:
    """Messages of one topic of a ROS log as a table.

    Attributes:
        table: A row per message, in SI.
        topic: The topic that was read.
    """

    table: RawTable
    topic: str

    @staticmethod
    def of(path: Path, columns: Mapping[str, Array], rows: TopicRows) -> "TopicTable":
        """Return columns of messages, by header, as the table of their topic.

        Args:
            path: The log.
            columns: Columns by header, shape (n,) each.
            rows: The messages.
        """
        import pandas as pd

        series = {name: pd.Series(values) for name, values in columns.items()}
        told = f"{path.name}: {rows.told}"
        return TopicTable(RawTable(path, series, notes=(told, *rows.notes)), rows.topic)
