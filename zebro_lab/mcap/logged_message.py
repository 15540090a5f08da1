# SPDX-License-Identifier: MIT
"""A decoded message of a ROS log, whatever the log's format."""

from typing import Any, NamedTuple


class LoggedMessage(NamedTuple):
    """Decoded ROS message of a log.

    Attributes:
        topic: Topic of the message.
        log_time: Time of logging since the Unix epoch [ns].
        content: The decoded message, an object with the message's fields as attributes.
        type: Name of its type, such as `sensor_msgs/msg/JointState`.
    """

    topic: str
    log_time: int
    content: Any
    type: str = ""
