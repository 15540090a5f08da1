# SPDX-License-Identifier: MIT
"""Commands and groups of our own: what they add to Typer's. The whole tree is tested above."""

from importlib.metadata import version
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from zebro_lab import main
from zebro_lab.files.provenance import software_commit
from zebro_lab.terminal.command_classes import Application


@pytest.fixture
def app() -> Application:
    app = Application(help="Two commands.")

    @app.callback()
    def both(seed: Annotated[int, typer.Option(metavar="N", help="Seed.")] = 0) -> None:
        """Do it. Or not."""

    @app.command()
    def one(
        file: Annotated[str, typer.Argument(metavar="FILE", help="A file.")],
        fast: Annotated[bool, typer.Option("--fast", help="Quickly.")] = False,
    ) -> None:
        """Read a file of which the name is long enough that the summary needs a second line.

        More about it.
        """

    @app.command()
    def two() -> None:
        """Do nothing. At all."""

    return app


def run(app: Application, *arguments: str):
    return CliRunner().invoke(app, arguments)


def test_summaries_are_first_sentences_as_a_whole(app):
    text = " ".join(run(app, "-h").output.split())
    assert "the name is long enough that the summary needs a second line two" in text
    assert "two Do nothing" in text
    assert "At all" not in text


def test_arguments_are_shown_by_their_metavar(app):
    text = run(app, "one", "-h").output
    assert "[OPTIONS] FILE\n" in text
    assert "  FILE  A file.  [required]\n" in text


def test_an_option_of_a_group_given_twice_is_wrong_usage(app):
    result = run(app, "--seed", "1", "--seed", "1", "two")
    assert result.exit_code == 2
    assert "'--seed': given twice; give it once" in result.stderr


TYPOS = {
    "walkk": "walk", "predcit": "predict", "validat": "validate", "recrod": "record",
    "cmpare": "compare", "reprot": "report", "calibrat": "calibrate", "zebra": "zebro",
    "rig plann": "plan", "camera kitt": "kit", "walk --speedup": None,
    "walk --gaitt tripod": "--gait",
    "predict x --slipp thesis": "--slip", "record --zebor sim": "--zebro",
    "plot d --form png": "--format", "track x --camra c": "--camera", "export d --ou q": "--out",
    "xyzzy": None, "analyse": None, "walk --colour red": None, "rig fly": None,
    "calibrate-slip x --maxsteps 3": "--max-steps", "calibrate-slip x --chains 4": None,
}  # fmt: skip


@pytest.mark.parametrize("typed", TYPOS)
def test_the_right_spelling_is_offered_alone_or_none(run_command, typed):
    ended = run_command(*typed.split())
    assert ended.code == 2
    line = ended.err.splitlines()[-1]
    meant = TYPOS[typed]
    assert "No such " in line
    assert line.partition(" Did you mean ")[2] == ("" if meant is None else f"'{meant}'?")
    assert "Possible options" not in ended.err


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("--duration", "2s", "found '2s'; expected a number"),
        ("--seed", "1.5", "found '1.5'; expected a whole number"),
        ("--gait", "tripot", "'--gait': 'tripot' is not a gait; did you mean 'tripod'?"),
    ],
)
def test_the_value_and_what_is_expected_are_named(run_command, option, value, message):
    ended = run_command("walk", "--slip", "thesis", option, value)
    assert ended.code == 2
    assert message in ended.err
    assert "Value error" not in ended.err


@pytest.mark.parametrize("program", [main.app, main.slip_app])
def test_version_is_that_of_package_and_commit(program):
    ended = CliRunner().invoke(program, ["--version"])
    assert ended.output == f"zebro-lab {version('zebro-lab')}, commit {software_commit()}\n"
