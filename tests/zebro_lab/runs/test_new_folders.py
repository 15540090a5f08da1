# SPDX-License-Identifier: MIT
"""Folders that a failed body created go, if they are empty."""

import pytest

from zebro_lab.runs.new_folders import removing_new_folders


def create(folder, *, file=None, error=None):
    """Create a folder, perhaps with a file beside it, and raise an error if there is one."""
    with removing_new_folders(folder):
        folder.mkdir(parents=True)
        if file is not None:
            file.touch()
        if error is not None:
            raise error


def test_new_folders_go_and_old_ones_stay(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        create(tmp_path / "a" / "b", error=KeyboardInterrupt())
    assert tmp_path.is_dir()
    assert not (tmp_path / "a").exists()


def test_a_folder_with_a_file_stays(tmp_path):
    with pytest.raises(OSError, match="disk"):
        create(tmp_path / "a" / "b", file=tmp_path / "a" / "mine", error=OSError("disk"))
    assert [path.name for path in (tmp_path / "a").iterdir()] == ["mine"]


def test_folders_stay_where_nothing_fails(tmp_path):
    create(tmp_path / "a")
    assert (tmp_path / "a").is_dir()
