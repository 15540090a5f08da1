# SPDX-License-Identifier: MIT
"""Read measured leg angles from a table, a ROS log, a walk folder or a recorded run."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from model.robot import N_LEGS
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.files.folder_manifest import such_folder_in
from zebro_lab.files.names import PATH_CSV, is_ros_log
from zebro_lab.files.replacement import recover
from zebro_lab.mcap.ros_log import bag_files
from zebro_lab.robot.leg_log import ANGLES, LEG_UNITS, LegLog, legs_of_table
from zebro_lab.runs.joint_log import joint_table, read_joint_log
from zebro_lab.runs.manifest import MANIFEST_FILE
from zebro_lab.runs.recorded_walk import is_recorded, read_recorded_legs
from zebro_lab.tables.columns import LEGS, Columns
from zebro_lab.tables.columns_file import read_mapped_columns
from zebro_lab.tables.columns_sections import columns_above
from zebro_lab.tables.table_files import read_table_file

_IN_A_RUN = (
    "use the part before or after it alone: write the run as tables (zebro-lab export RUN --out "
    "TABLES), delete the other part's rows in legs.csv, and predict from that file"
)


@dataclass(frozen=True)
class LegNames:
    """What an option says of the names in a leg log.

    Attributes:
        joints: Columns or joints of legs 1 to 6, in this order; empty for those of the column map.
        topics: Topics of a ROS log to prefer; those of other messages are ignored.
        topic: The topic of a ROS log to read; None for one of `topics`, else the only one.
    """

    joints: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()
    topic: str | None = None


def read_leg_log(
    path: Path,
    *,
    columns: Path | None = None,
    leg_sign: Sequence[int] = (1,) * N_LEGS,
    names: LegNames | None = None,
) -> LegLog:
    """Read leg angles over time from a table or a ROS log: `t` [s], `theta1` to `theta6` [rad].

    Other names and units are mapped by a `columns.toml`. Angles may be wrapped to one turn.

    Args:
        path: Table file; MCAP log or bag with joint states; a walk folder, read from its path.csv;
            or a recorded run, to be decoded.
        columns: A `columns.toml` instead of the one beside the table; ignored for a recorded run.
        leg_sign: Factor of each leg's angles, 1 or -1, shape (6,); see robot.toml.
        names: Names of topic and joints; None to find them.

    Raises:
        NotFound: A file does not exist.
        SettingsError: The `columns.toml` has an invalid value, or nothing is read from one of the
            topics to prefer.
        DataError: The file or run cannot be read, a leg is missing, a cell holds no finite number,
            there are not two rows, time does not increase or has a gap that is not bridged, or a
            leg turns by more than 2.5 rad between samples; names the cell, if it is one.
    """
    if is_recorded(path):
        table, files = read_recorded_legs(path)
        mapping = Columns(LEG_UNITS)
        return legs_of_table(table, mapping, files=files, leg_sign=leg_sign, mending=_IN_A_RUN)
    file = path if is_ros_log(path) else _table_of(path)
    mapping, topic = read_mapped_columns(LEGS, file, columns, LEG_UNITS)
    names = replace(names or LegNames(), topic=topic)
    log, used = legs_of_file(file, mapping, names=names, leg_sign=leg_sign)
    require_used(names.topics, [used])
    return replace(log, notes=(*log.notes, *columns_above(LEGS, file, columns)))


def legs_of_file(
    path: Path,
    mapping: Columns,
    *,
    names: LegNames | None = None,
    leg_sign: Sequence[int] = (1,) * N_LEGS,
) -> tuple[LegLog, str | None]:
    """Read leg angles from a table or a ROS log with a given column map.

    Args:
        path: The file, or the folder of a bag.
        mapping: Column map with the canonical names of `LEG_UNITS`.
        names: Names of topic and joints; None to find them.
        leg_sign: As in `read_leg_log`.

    Returns:
        The leg angles, and the topic that was read of a ROS log.

    Raises:
        NotFound: There is no such file, or no package that reads it.
        DataError: As `read_leg_log`.
    """
    names = names or LegNames()
    for leg, joint in zip(ANGLES, names.joints, strict=False):
        mapping = mapping.called(leg, joint)
    if not is_ros_log(path):
        table = read_table_file(path, sheet=mapping.sheet)
        return legs_of_table(table, mapping, files=(path,), leg_sign=leg_sign), None
    log = read_joint_log(path, topic=names.topic, topics=names.topics)
    table = joint_table(log, mapping)
    files = bag_files(path)
    return legs_of_table(table, mapping, files=files, leg_sign=leg_sign), log.topic


def require_used(topics: Sequence[str], used: Sequence[str | None]) -> None:
    """Check that every topic of `--topic` was read.

    Raises:
        SettingsError: A topic was not.
    """
    for topic in topics:
        if topic not in used:
            read = ", ".join(each for each in used if each is not None) or "no topic of a ROS log"
            raise SettingsError(f"found {topic}, but nothing is read from it; read: {read}",
                                key="--topic")  # fmt: skip


def _table_of(path: Path) -> Path:
    """Return the table at a path: the path itself, or the `path.csv` of a walk folder.

    Raises `DataError` for a folder without one.
    """
    recover(path)
    if not path.is_dir():
        return path
    if (path / PATH_CSV).is_file():
        return path / PATH_CSV
    raise DataError(
        f"is a folder without {PATH_CSV}, run.json or metadata.yaml; give a walk folder, a run "
        f"folder, a bag, or a table with the columns t and {ANGLES[0]} to {ANGLES[-1]}"
        f"{such_folder_in(path, MANIFEST_FILE)}",
        file=path,
    )
