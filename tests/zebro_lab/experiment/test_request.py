# SPDX-License-Identifier: MIT
"""Masses of a check of the load cell are numbers, or a fault of usage."""

import pytest
import typer
from typer.testing import CliRunner

from zebro_lab.experiment.request import STANDARD_GRAVITY, WeighRequest
from zebro_lab.terminal.request_command import request_command


def run(*arguments):
    taken = []
    app = typer.Typer()

    @app.command()
    @request_command()
    def weigh(request: WeighRequest) -> None:
        taken.append(request)

    return CliRunner().invoke(app, ["--rig", "sim", *arguments]), taken


def test_masses_are_numbers_in_the_order_given():
    _, [request] = run("--masses", "0.2,0.5,1")
    assert request == WeighRequest("sim", (0.2, 0.5, 1.0), gravity=STANDARD_GRAVITY)


@pytest.mark.parametrize("masses", [("--masses", "0.2;0.5"), ("--masses", ""), ()])
def test_anything_else_is_wrong_usage(masses):
    result, taken = run(*masses)
    assert (result.exit_code, taken) == (2, [])
