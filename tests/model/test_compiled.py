# SPDX-License-Identifier: MIT
import subprocess
import sys

import pytest

from model.compiled import delete_stale_loops


@pytest.fixture
def package(tmp_path):
    """A package with a compiled function, another that calls it, and what numba stored of both."""
    (tmp_path / "walk" / "__pycache__").mkdir(parents=True)
    (tmp_path / "plain.py").write_text("SIZE = 1\n")
    (tmp_path / "walk" / "steps.py").write_text("from model.compiled import compiled\n")
    (tmp_path / "walk" / "state.py").write_text("from model.compiled import compiled\n")
    delete_stale_loops(tmp_path)
    (tmp_path / "walk" / "__pycache__" / "steps.step-3.py312.nbi").write_bytes(b"index")
    (tmp_path / "walk" / "__pycache__" / "steps.step-3.py312.1.nbc").write_bytes(b"code")
    return tmp_path


def stored(package):
    return sorted(path.suffix for path in package.rglob("*.nb[ic]"))


def test_loops_of_unchanged_sources_are_kept(package):
    (package / "plain.py").write_text("SIZE = 2\n")
    delete_stale_loops(package)
    assert stored(package) == [".nbc", ".nbi"]


def test_a_changed_or_moved_source_deletes_the_loops_that_may_call_it(package):
    (package / "walk" / "state.py").rename(package / "walk" / "states.py")
    delete_stale_loops(package)
    assert stored(package) == []


def test_a_package_that_cannot_be_written_is_left_as_it_is(package, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError

    (package / "walk" / "state.py").write_text("from model.compiled import borrowing\n")
    monkeypatch.setattr("pathlib.Path.unlink", refuse)
    delete_stale_loops(package)
    assert stored(package) == [".nbc", ".nbi"]


NOWHERE = """
from numba.core import caching
caching.CacheImpl._locator_classes = []  # as where neither package nor home can be written
from model.compiled import compiled
print(compiled(lambda x: x + 4)(-2))
"""


def test_loops_are_compiled_where_nothing_can_be_stored():
    program = [sys.executable, "-c", NOWHERE]
    assert subprocess.run(program, capture_output=True, text=True, check=True).stdout == "2\n"
