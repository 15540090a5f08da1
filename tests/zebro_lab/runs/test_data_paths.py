# SPDX-License-Identifier: MIT
"""Which files a folder named on the command line stands for."""

import pytest

from zebro_lab.runs.data_paths import find_sources
from zebro_lab.runs.folder import find_runs
from zebro_lab.runs.manifest import MANIFEST_FILE


@pytest.fixture
def circle(tmp_path):
    """Return a folder that holds a table, a run folder, and links to itself."""
    folder = tmp_path / "data"
    (folder / "run").mkdir(parents=True)
    (folder / "good.csv").write_text("t\n0\n")
    (folder / "run" / MANIFEST_FILE).write_text("{}")
    for name in ("a", "s1", "s2"):
        (folder / name).symlink_to(".")
    return folder


@pytest.mark.timeout(20)
def test_folders_that_link_to_themselves_are_walked_once(circle):
    sources = find_sources([circle])
    assert [source.path for source in sources] == [circle / "good.csv", circle / "run"]
    assert find_runs(circle) == [circle / "run"]


def test_a_folder_behind_a_link_is_data(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "disk" / "good.csv").write_text("t\n0\n")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "day").symlink_to(tmp_path / "disk")
    [source] = find_sources([tmp_path / "data"])
    assert source.path == tmp_path / "data" / "day" / "good.csv"
