# SPDX-License-Identifier: MIT
"""Read messages of ROS logs: MCAP without what is damaged; SQLite (.db3) and ROS 1 up to it."""

from collections.abc import Collection
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcap.records import Schema
from mcap.well_known import MessageEncoding
from mcap_ros2.decoder import DecoderFactory

from zebro_lab.files.errors import NotFound
from zebro_lab.files.names import BAG_METADATA, is_bag
from zebro_lab.files.opening import open_file, parsing
from zebro_lab.mcap.log_records import Decode, LoggedMessage, read_log_messages

if TYPE_CHECKING:
    from rosbags.highlevel import AnyReader


def bag_files(path: Path) -> tuple[Path, ...]:
    """Return the files of a bag: itself, or those in its folder by name.

    Raises:
        NotFound: There is no such file, or a folder lacks its metadata.yaml.
        DataError: One of them is not a regular file or cannot be opened.
    """
    files = (path,)
    if path.is_dir():
        if not (path / BAG_METADATA).is_file():
            raise NotFound(
                f"{path}: {BAG_METADATA} of the bag is missing; copy the whole folder, or write it "
                f"anew with: ros2 bag reindex {path}"
            )
        logs = (f for f in sorted(path.iterdir()) if f.suffix.lower() in (".db3", ".mcap", ".zstd"))
        files = (path / BAG_METADATA, *logs)
    for file in files:
        with open_file(file):
            pass
    return files


def read_messages(path: Path, types: Collection[str]) -> tuple[list[LoggedMessage], str | None]:
    """Read all messages of some types from a ROS log, but for what is damaged.

    A message or a definition of a type that cannot be decoded counts as damage.

    Args:
        path: The log: MCAP of ROS 2, or a bag, which the package `rosbags` reads.
        types: Names of the types, such as `sensor_msgs/msg/JointState`, also for ROS 1.

    Returns:
        The messages in the order of the log, and what of it is damaged or cut off; None for a log
        without damage. A bag other than MCAP is read up to its first damage. Of a bag of several
        MCAP files, all of them by time of logging, and the damage of the first file that is
        damaged; the others are read nevertheless.

    Raises:
        NotFound: The file does not exist, or the package `rosbags` for a bag.
        DataError: The file is not regular, cannot be opened, or is not MCAP or a bag.
    """
    with redirect_stdout(StringIO()):  # decoders print what they do not understand
        if path.is_dir() and (parts := sorted(path.glob("*.mcap"))):
            read = [_read_mcap(part, types) for part in parts]
            messages = sorted((m for found, _ in read for m in found), key=lambda m: m.log_time)
            return messages, next((damage for _, damage in read if damage is not None), None)
        return _read_bag(path, types) if is_bag(path) else _read_mcap(path, types)


def _read_bag(path: Path, types: Collection[str]) -> tuple[list[LoggedMessage], str | None]:
    """Read messages of a bag with rosbags, as `read_messages` says."""
    bag_files(path)
    messages: list[LoggedMessage] = []
    problem = "cannot be read as a ROS bag"
    with parsing(path, problem, advice="record or copy it again"), _reader(path) as reader:
        wanted = [each for each in reader.connections if each.msgtype in types]
        try:
            for connection, time, data in reader.messages(wanted) if wanted else ():
                content: Any = reader.deserialize(data, connection.msgtype)
                messages.append(LoggedMessage(connection.topic, time, content, connection.msgtype))
        except Exception as error:  # damage is answered with whatever went wrong inside
            return messages, f"{type(error).__name__}: {error}"
    return messages, None


def _reader(path: Path) -> "AnyReader":
    """Return a reader of a bag, to be opened; raise `NotFound` if rosbags is not installed."""
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise NotFound(
            f"{path}: reading bags other than MCAP needs the package rosbags; install it with "
            "pip install rosbags, or convert the bag: ros2 bag convert, or the "
            "command mcap convert"
        ) from error
    # Bags of ROS 2 before Iron do not hold the definitions of their messages.
    return AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE))


def _read_mcap(path: Path, types: Collection[str]) -> tuple[list[LoggedMessage], str | None]:
    """Read messages of an MCAP log, as `read_messages` says."""
    factory = DecoderFactory()

    def decoder(schema: Schema) -> Decode | None:
        """Return what decodes messages of the wanted types; None for others."""
        return factory.decoder_for(MessageEncoding.CDR, schema) if schema.name in types else None

    return read_log_messages(path, decoder)
