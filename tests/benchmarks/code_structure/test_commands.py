# SPDX-License-Identifier: MIT
"""Options are counted from the tree of commands, and modules by the functions that run."""

import pytest

from benchmarks.code_structure.commands import option_measures, probe
from benchmarks.code_structure.measures import Checkout

MAIN = """import typer

from model import used, unused

app = typer.Typer()


@app.command()
def walk(name: str, speed: float = 1.0, json: bool = False) -> None:
    used.twice(speed)


@app.command()
def track(quiet: bool = False, every: int = 1) -> None: ...


@app.command()
def predict() -> None: ...


@app.command()
def calibrate() -> None: ...


def main() -> None:
    app()
"""


@pytest.fixture
def root(tmp_path):
    files = {"zebro_lab/main.py": MAIN, "model/used.py": "def twice(a):\n    return 2 * a\n",
             "model/unused.py": "def thrice(a):\n    return 3 * a\n"}  # fmt: skip
    files |= {f"{each}/__init__.py": "" for each in ("zebro_lab", "rig", "tracking", "model")}
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def test_options_are_counted_but_those_that_all_commands_have(root):
    found = option_measures(Checkout.read(root))
    assert found["options of all commands"].figure == "2"
    assert found["options of walk"].places == ("--speed",)
    assert found["options of track"].places == ("--every",)


def test_modules_count_whose_functions_run(root):
    assert probe(root, "modules", "walk", "Z") == '["model/used.py", "zebro_lab/main.py"]'


def test_a_command_that_fails_is_an_error_with_its_message(root):
    with pytest.raises(SystemExit, match="No such command 'fly'"):
        probe(root, "modules", "fly")
