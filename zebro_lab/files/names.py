# SPDX-License-Identifier: MIT
"""File names used by more than one room, of ROS logs among them; distinct names of files."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

PATH_CSV: Final = "path.csv"
"""Table of the path in a walk folder, one row per time step."""
TRACK: Final = "track"
"""Subfolder of a run folder that holds the track of the run."""
BAG_SUFFIXES: Final = (".db3", ".bag")
BAG_METADATA: Final = "metadata.yaml"
"""File in the folder of a bag of ROS 2."""


def numbered(names: Sequence[str]) -> list[str]:
    """Append `-1`, `-2`, … to every name that occurs more than once, in order of occurrence.

    >>> numbered(["a", "b", "a"])
    ['a-1', 'b', 'a-2']
    """
    return [
        name if names.count(name) == 1 else f"{name}-{names[: i + 1].count(name)}"
        for i, name in enumerate(names)
    ]


def shortest_distinct(paths: Sequence[Path]) -> list[str]:
    """Shorten all paths to the same number of last parts, the fewest that keep them distinct.

    If two of the paths are equal, all paths are returned whole.

    >>> shortest_distinct([Path("a/one/log.mcap"), Path("a/two/log.mcap")])
    ['one/log.mcap', 'two/log.mcap']
    """
    depths = range(1, max((len(path.parts) for path in paths), default=1) + 1)
    shortened = ([str(Path(*path.parts[-depth:])) for path in paths] for depth in depths)
    whole = [str(path) for path in paths]
    return next((names for names in shortened if len(set(names)) == len(names)), whole)


def is_bag(path: Path) -> bool:
    """Return whether a path is a ROS bag: a name in .db3 or .bag, or the folder of a bag.

    Such a folder holds metadata.yaml, or files .db3 where that is missing.
    """
    if path.suffix.lower() in BAG_SUFFIXES or (path / BAG_METADATA).is_file():
        return True
    return path.is_dir() and any(path.glob("*.db3"))


def is_ros_log(path: Path) -> bool:
    """Return whether a path is a ROS log by its name: .mcap, .db3, .bag, or the folder of a bag."""
    return path.suffix.lower() == ".mcap" or is_bag(path)
