# SPDX-License-Identifier: MIT
"""`zebro-lab` lists every command, and each of them explains itself."""

import pytest
from typer.main import get_command

from zebro_lab import main
from zebro_lab.main import app, slip_app

COMMANDS = {
    "calibrate", "read-off", "init", "walk", "reach", "predict", "validate", "compare", "report",
    "record", "import", "runs", "plot", "exclude", "export", "track", "annotate", "doctor",
    "camera", "rig", "sim", "zebro",
}  # fmt: skip


def test_every_command_is_there_and_listed(run_command):
    assert set(get_command(app).commands) == COMMANDS
    ended = run_command("--help")
    assert ended.code == 0
    for name in COMMANDS:
        assert f" {name} " in ended.out
    assert "Measure how a six-legged robot's feet slip" in ended.out


def test_no_command_is_help_and_another_is_wrong_usage(run_command):
    ended = run_command()
    assert ended.code == 2
    assert "[OPTIONS] COMMAND [ARGS]" in ended.err
    assert " calibrate " in ended.err
    assert run_command("walkk").code == 2


@pytest.mark.parametrize(("script", "started"), [(main.main, app), (main.calibrate_slip, slip_app)])
def test_each_script_runs_its_own_commands(monkeypatch, script, started):
    ran = []
    monkeypatch.setattr(main, "run", ran.append)
    script()
    assert ran == [started]
