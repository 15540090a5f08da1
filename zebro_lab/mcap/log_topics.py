# SPDX-License-Identifier: MIT
"""Choose one topic of a ROS log among those of some types, and date its messages."""

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from model.counted import counted
from model.similar_name import nearest
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.mcap.log_records import LoggedMessage
from zebro_lab.mcap.ros_log import read_messages

OTHER_FIELDS: Final = "has messages with other fields than ROS defines"
"""What is wrong with a log whose description of a message is damaged, for `parsing`."""
NANOSECOND: Final = 1e-9
_TOLD: Final = '--topic NAME, or topic = "NAME" in the file\'s section of a columns.toml'

Parts = Iterable[tuple[str, Any, Any]]


class SeveralTopics(DataError):
    """Several topics of a log have what is looked for, and none was asked for."""


@dataclass(frozen=True)
class TopicRows:
    """Messages of one topic.

    Attributes:
        topic: The topic.
        type: Type of its first message.
        t: Stamp of each message, or its log time where it has none [s].
        contents: What each message holds.
        notes: Notes, one line each.
    """

    topic: str
    type: str
    t: tuple[float, ...]
    contents: tuple[Any, ...]
    notes: tuple[str, ...]

    @property
    def told(self) -> str:
        """Topic, type and number of the messages, for a note."""
        return f"topic {self.topic}, {self.type}, {counted(len(self.t), 'message')}"


def whole(message: LoggedMessage) -> Parts:
    """Yield a message as one part: its topic, header and content."""
    yield message.topic, message.content.header, message.content


def read_topic(
    path: Path,
    types: Collection[str],
    *,
    what: str,
    topic: str | None = None,
    topics: Collection[str] = (),
    parts: Callable[[LoggedMessage], Parts] = whole,
) -> TopicRows:
    """Read the messages of one topic of a ROS log, without what is damaged.

    Args:
        path: The log.
        types: Types of messages that are wanted.
        what: What is looked for, such as "joint positions", for messages.
        topic: The topic to read; None for one of `topics`, else for the only one.
        topics: Topics to prefer; those of other types are ignored.
        parts: Splits a message into parts: topic, header and content of each; none to skip it.

    Raises:
        NotFound: The log does not exist, or the package that reads it.
        SeveralTopics: Several topics fit: of `topics`, or of all if the log has none of these.
        DataError: It cannot be read, or has no such message, or not the topic that is asked for.
    """
    messages, damage = read_messages(path, types)
    found: dict[str, list[tuple[float, str, Any]]] = {}
    with parsing(path, OTHER_FIELDS):
        for name, stamp, kind, content in _stamped(messages, parts):
            found.setdefault(name, []).append((stamp, kind, content))
    if not found:
        raise DataError(
            f"holds no {what}; expected messages of type {', '.join(sorted(types))}, or of a run "
            "that zebro-lab recorded the run's folder",
            file=path,
        )
    if topic is not None and topic not in found:
        raise DataError(f"has no {what} on topic {topic}; {nearest(topic, found)}", file=path)
    fitting = [topic] if topic else [each for each in found if each in topics] or sorted(found)
    if len(fitting) > 1:
        problem = f"has {what} on the topics {', '.join(sorted(fitting))}; choose one with {_TOLD}"
        raise SeveralTopics(problem, file=path)
    chosen = fitting[0]
    t, kinds, contents = zip(*found[chosen], strict=True)
    notes = [] if damage is None else [f"{path.name} is incomplete ({damage})"]
    if len(found) > 1:
        others = ", ".join(sorted(set(found) - {chosen}))
        notes.append(f"{path.name}: {what} are taken from topic {chosen}, not from {others}")
    return TopicRows(chosen, kinds[0], t, contents, tuple(notes))


def _stamped(
    messages: Iterable[LoggedMessage], parts: Callable[[LoggedMessage], Parts]
) -> Iterator[tuple[str, float, str, Any]]:
    """Yield topic, time [s], type and content of each part of messages.

    The time is the stamp of the header, or the log time where that is 0, which means not set.
    """
    for message in messages:
        for topic, header, content in parts(message):
            stamp = header.stamp.sec + NANOSECOND * header.stamp.nanosec
            yield topic, stamp or NANOSECOND * message.log_time, message.type, content
