# SPDX-License-Identifier: MIT
"""The time of an import is a moment, or a fault of usage."""

from datetime import UTC, datetime
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.terminal.request_command import request_command


def run(*arguments):
    taken = []
    app = typer.Typer()

    @app.command()
    @request_command()
    def take(request: ImportRequest, _: Annotated[bool, typer.Option("--dry")] = False) -> None:
        taken.append(request)

    return CliRunner().invoke(app, ["--data", "data", *arguments]), taken


def test_a_start_is_read_as_a_moment():
    _, [request] = run("--start", "2026-03-04T05:06:07+00:00")
    assert request.start == datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)
    _, [request] = run()
    assert request.start is None


@pytest.mark.parametrize("start", ["yesterday", "2026-13-01"])
def test_another_text_is_wrong_usage(start):
    result, taken = run("--start", start)
    assert (result.exit_code, taken) == (2, [])
    assert f"found '{start}'" in result.output
