# SPDX-License-Identifier: MIT
from pathlib import Path

import pytest

from benchmarks.code_structure.checkout import Module
from benchmarks.mirrored_tests import broken, main

CHOICE = '''"""Choices."""


def small(a):
    return a


def larger(a, b):
    """Return the larger.

    It has a docstring.
    """
    if a > b:
        return a
    return b
'''
CASES = {
    "def f():\n    if 1:\n        return 2\n": "def f():\n    return None\n",
    "class A:\n    def f(self, x, y):\n        return x if y else 0\n": (
        "class A:\n    def f(self, x, y):\n        return x\n"
    ),
    "class A:\n    @staticmethod\n    def f(x):\n        return x or 1\n": (
        "class A:\n    @staticmethod\n    def f(x):\n        return x\n"
    ),
    "def f(*, n):\n    for i in n:\n        yield i\n": "def f(*, n):\n    yield n\n",
    "def f(n): return n or 1\n\n\nx = 1\n": "def f(n): \n    return n\n\n\nx = 1\n",
}


@pytest.mark.parametrize("text", CASES)
def test_the_largest_function_returns_its_first_argument(text):
    found = broken(Module(Path("model/a.py"), text))
    assert found == CASES[text]
    compile(found, "a.py", "exec")


def test_a_docstring_stays():
    found = broken(Module(Path("model/a.py"), CHOICE))
    assert found == CHOICE.replace(
        "    if a > b:\n        return a\n    return b\n", "    return a\n"
    )


@pytest.mark.parametrize("body", ['"""Do nothing."""', "...", '"""Do nothing."""\n    ...'])
def test_a_function_that_does_nothing_is_not_replaced(body):
    empty = f"def f(\n    a: int,\n    b: int,\n    c: int,\n):\n    {body}\n"
    assert broken(Module(Path("model/a.py"), empty)) is None
    found = broken(Module(Path("model/a.py"), f"{empty}\n\ndef g(a):\n    return a or 1\n"))
    assert found == f"{empty}\n\ndef g(a):\n    return a\n"


def test_a_test_that_looks_away_survives_and_one_that_looks_does_not(tmp_path, capsys):
    for name, claim in (("seen", "larger(1, 2) == 2"), ("unseen", "larger(2, 1) == 2")):
        (tmp_path / "model").mkdir(exist_ok=True)
        (tmp_path / "tests" / "model").mkdir(parents=True, exist_ok=True)
        (tmp_path / "model" / "__init__.py").touch()
        (tmp_path / "model" / f"{name}.py").write_text(CHOICE)
        (tmp_path / "tests" / "model" / f"test_{name}.py").write_text(
            f"from model.{name} import larger\n\n\ndef test_it():\n    assert {claim}\n"
        )
    assert main([str(tmp_path)]) == 1
    said = capsys.readouterr().out
    assert "1 of 2 replaced functions were noticed" in said
    assert "| model/unseen.py | larger | SURVIVED |" in said
