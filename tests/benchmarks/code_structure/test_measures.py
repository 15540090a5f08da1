# SPDX-License-Identifier: MIT
"""A made-up checkout has the figures that were planted in it."""

import pytest

from benchmarks.code_structure.__main__ import main
from benchmarks.code_structure.checkout import read_modules
from benchmarks.code_structure.deleted import deleted
from benchmarks.code_structure.measures import MEASURES, Checkout, without_args

FILES = {
    "model/__init__.py": '"""Mathematics."""\n',
    "model/path.py": '''"""A path."""

# a comment


class Path:
    """Where it went."""

    t: float
    x: float
    y: float
    yaw: float


def turn(path, angle):
    """Turn it.

    It is long.
    """
    if angle:
        return path

    return None
''',
    "zebro_lab/walk.py": '''"""Walks."""


class Path:
    position: float


def walk(a, b):
    """Walk.

    Args:
        a: One.
        b: Other.
    """
    import math

    return math.hypot(a, b)


def _hidden(a, b):
    return a
''',
    "rig/long.py": "x = 1\n" * 351,
    "tracking/seen.py": "y = 1 if True else 2\n",
    "tests/tracking/test_seen.py": "",
    "docs/decisions/0001-one.md": "# One\n",
    "CHANGELOG.md": "# Changes\n\n",
}


@pytest.fixture
def root(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def test_every_measure_finds_what_was_planted(root):
    checkout = Checkout.read(root)
    found = {what: measure(checkout) for what, measure in MEASURES.items()}
    assert {what: each.figure for what, each in found.items()} == {
        "lines of code": "368",
        "lines of code of tests": "0",
        "lines of code of benchmarks": "0",
        "lines of documents and changelog": "3",
        "decision records": "1",
        "lines of a function: median, 90 %": "9, 10",
        "the same without docstrings, comments, blanks": "3, 4",
        "files over 350 lines": "1",
        "modules in the fullest folder": "1",
        "modules at the top of zebro_lab": "1",
        "names of public classes defined more than once": "1",
        "classes with time, position and heading": "1",
        "modules with a branch and no test module of their name": "1",
        "public functions of two or more parameters without Args": "1",
        "imports inside functions": "1",
    }
    places = {what: each.places for what, each in found.items()}
    assert places["files over 350 lines"] == ("351 rig/long.py",)
    assert places["names of public classes defined more than once"] == (
        "Path: zebro_lab.walk, model.path",
    )
    [without] = places["public functions of two or more parameters without Args"]
    assert without.endswith("turn")
    assert places["modules with a branch and no test module of their name"] == ("model/path.py",)
    assert places["imports inside functions"] == ("zebro_lab/walk.py:15 import math",)


COMMANDS = '''"""Commands."""

from typing import Annotated

import typer

Out = Annotated[str, typer.Option(help="Where to.")]


def export(run: Annotated[str, typer.Argument()], out: Out = "out"):
    """Export."""


@app.command()
@request_command()
def walk(request: WalkRequest, out: Out = "out"):
    """Walk."""


def half_described(run: str, out: Out = "out"):
    """Export."""
'''


def test_options_of_commands_are_described_by_their_help(tmp_path):
    (tmp_path / "zebro_lab").mkdir()
    (tmp_path / "zebro_lab/command.py").write_text(COMMANDS)
    [without] = without_args(Checkout.read(tmp_path)).places
    assert without.endswith("half_described")


def test_a_docstring_a_comment_and_a_blank_line_are_no_code(root):
    assert len(read_modules(root)["model.path"].code_lines) == 9


def test_what_moved_is_not_deleted_and_what_went_is(root, tmp_path):
    before = Checkout.read(root)
    text = FILES["zebro_lab/walk.py"]
    (root / "zebro_lab/walk.py").unlink()
    (root / "zebro_lab/walk").mkdir()
    (root / "zebro_lab/walk/stage.py").write_text(text.replace("def walk(", "def stroll("))
    assert deleted(before, Checkout.read(root)) == ["zebro_lab.walk.walk"]


def test_two_checkouts_are_two_columns(root, rows):
    main([str(root), str(root)])
    table = rows()
    assert len(table) == len(MEASURES)
    assert all(len(row) == 3 and row[1] == row[2] for row in table)
