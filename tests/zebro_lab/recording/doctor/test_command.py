# SPDX-License-Identifier: MIT
"""`doctor` fails only where something needed is broken."""

from typer.testing import CliRunner

from zebro_lab.main import app
from zebro_lab.recording.doctor import packages
from zebro_lab.recording.doctor.finding import Finding, Grade


def test_the_command_fails_only_where_something_needed_is_broken(monkeypatch, tmp_path):
    done = CliRunner().invoke(app, ["doctor", "--data", str(tmp_path)])
    assert (done.exit_code, "everything that zebro-lab needs is there" in done.output) == (0, True)
    monkeypatch.setattr(packages, "check_python", lambda _: Finding(Grade.BROKEN, "p", "old"))
    done = CliRunner().invoke(app, ["doctor", "--data", str(tmp_path)])
    assert (done.exit_code, "1 BROKEN" in done.output) == (1, True)
