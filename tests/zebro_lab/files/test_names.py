# SPDX-License-Identifier: MIT
"""Names of several files are distinct and short."""

from pathlib import Path

from zebro_lab.files.names import shortest_distinct


def test_files_of_one_name_are_told_apart_by_as_few_folders_as_needed():
    assert shortest_distinct([Path("data/a.csv"), Path("data/b.csv")]) == ["a.csv", "b.csv"]
    runs = [Path("data/run1/log.mcap"), Path("data/run2/log.mcap")]
    assert shortest_distinct(runs) == ["run1/log.mcap", "run2/log.mcap"]
    alike = ["x/r/log.mcap", "y/r/log.mcap"]
    assert shortest_distinct([*map(Path, alike)]) == alike
    assert shortest_distinct([]) == []
