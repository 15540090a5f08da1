# SPDX-License-Identifier: MIT
"""Mutations change one node, are found in moved functions, and survive tests that look away."""

import ast

import numpy as np
import pytest

from benchmarks.code_structure.checkout import Module, read_modules
from benchmarks.code_structure.measures import Checkout
from benchmarks.mutations import drawn, main, mutated, sites

CHANGES = {
    "def f(a):\n    return a < 2\n": {
        ("comparison", "def f(a):\n    return a <= 2"),
        ("constant", "def f(a):\n    return a < 3"),
    },
    "def f(a, b=1):\n    return a[-1] - b\n": {
        ("index", "def f(a, b=1):\n    return a[-1 + 1] - b"),
        ("sign", "def f(a, b=1):\n    return a[-1] + b"),
        ("sign", "def f(a, b=1):\n    return a[+1] - b"),
        ("constant", "def f(a, b=1):\n    return a[-2] - b"),
    },
    "def f(a):\n    return a['x'] * True\n": set(),
}
CHOICE = '''"""Choices."""


class Choice:
    @staticmethod
    def larger(a, b):
        """Return the larger."""
        # a comment
        if a > b:
            return a
        return b
'''
LOOKS = """from model.choice import Choice


def test_larger():
    assert Choice.larger(2, 1) == 2
    assert Choice.larger(1, 2) == 2
    assert Choice.larger(1, 1.0) is not None
"""


@pytest.mark.parametrize("text", CHANGES)
def test_a_mutation_changes_one_node_of_the_body(text):
    [function] = ast.parse(text).body
    found = {(each.kind, ast.unparse(mutated(function, each))) for each in sites(function)}
    assert found == CHANGES[text]
    assert ast.unparse(function) == text.strip()


def test_the_same_node_is_changed_where_docstring_and_annotations_differ():
    bare = "def f(a, b):\n    return a - b[0]"
    other = 'def f(a: "int | None", b: list[int]) -> int:\n    """Subtract."""\n    return a - b[0]'
    [function], [theirs] = ast.parse(bare).body, ast.parse(other).body
    for each in sites(function):
        assert ast.unparse(mutated(theirs, each).body[1]) == ast.unparse(
            mutated(function, each).body[0]
        )


def write(root, home, tests):
    files = {"model/__init__.py": "", f"model/{home}": CHOICE, f"tests/model/test_{home}": tests}
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)


def test_a_function_that_moved_is_drawn_and_one_that_changed_is_not(tmp_path):
    for name in ("before", "after"):
        write(tmp_path / name, f"{name}.py", LOOKS)
    before, after = (Checkout.read(tmp_path / name) for name in ("before", "after"))
    assert [each.kind for each in drawn(before, after, np.random.default_rng(1))] == ["comparison"]
    changed = Module(after.modules["model.after"].path, CHOICE.replace("a > b", "b < a"))
    after = Checkout(after.root, {"model.after": changed})
    assert list(drawn(before, after, np.random.default_rng(1))) == []
    assert read_modules(tmp_path / "before").keys() == {"model", "model.before"}


@pytest.mark.long
@pytest.mark.parametrize(("sharp", "told"), [(True, "1 of 1"), (False, "0 of 1")])
def test_tests_that_look_notice_and_tests_that_look_away_do_not(tmp_path, capsys, sharp, told):
    looks = LOOKS.replace(
        "1, 1.0) is not None", "1, 1.0) == 1.0 and type(Choice.larger(1, 1.0)) is float"
    )
    write(tmp_path / "before", "choice.py", looks)
    write(tmp_path / "after", "choice.py", looks if sharp else "def test_nothing():\n    pass\n")
    code = main([str(tmp_path / "before"), str(tmp_path / "after"), "--n", "1"])
    assert f"{told} mutations were noticed" in capsys.readouterr().out
    assert code == (0 if sharp else 1)
