# SPDX-License-Identifier: MIT
"""Commands and groups of our own: what they add to Typer's. The whole tree is tested above."""

from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

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


def test_a_flag_may_be_given_twice(app):
    assert run(app, "one", "x", "--fast", "--fast").exit_code == 0


def test_each_program_completes_in_a_shell(app):
    assert "--install-completion" in run(app, "-h").output
