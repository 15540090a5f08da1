# SPDX-License-Identifier: MIT
"""How a command ends."""

import pytest
import typer

from model.errors import FitError
from zebro_lab.files.errors import DataError
from zebro_lab.terminal.ending import run


def app_that_raises(error: Exception) -> typer.Typer:
    app = typer.Typer()

    @app.command()
    def command() -> None:
        raise error

    return app


@pytest.fixture(autouse=True)
def no_arguments(monkeypatch):
    monkeypatch.setattr("sys.argv", ["command"])


@pytest.mark.parametrize("error", [DataError("is empty", file="a.csv"), FitError("no start")])
def test_known_error_is_one_line_and_exit_1(error, capsys):
    with pytest.raises(SystemExit) as ended:
        run(app_that_raises(error))
    assert ended.value.code == 1
    assert ended.value.__suppress_context__
    assert capsys.readouterr() == ("", f"error: {error}\n")


def test_unknown_error_keeps_its_traceback():
    with pytest.raises(ZeroDivisionError) as caught:
        run(app_that_raises(ZeroDivisionError("a bug")))
    assert caught.traceback[-1].name == "command"
