# SPDX-License-Identifier: MIT
"""Without a folder to write no files are kept; a named one is neither made nor removed."""

import pytest

from zebro_lab.front.defaults import kept_or_temporary


def test_a_result_is_kept_where_it_is_named(tmp_path):
    with kept_or_temporary(str(tmp_path / "mine")) as folder:
        assert folder == tmp_path / "mine"
        folder.mkdir()
    assert folder.is_dir()


def test_an_unnamed_result_is_removed_whatever_happens():
    folders = []

    def fail() -> None:
        with kept_or_temporary(None) as folder:
            folders.append(folder)
            assert not folder.exists()
            folder.mkdir()  # in a folder that is there
            raise ValueError("diverged")

    with pytest.raises(ValueError, match="diverged"):
        fail()
    assert not folders[0].parent.exists()
