# SPDX-License-Identifier: MIT
"""`calibrate-slip` needs something to fit."""

import pytest

from zebro_lab.main import slip_app as app
from zebro_lab.terminal.ending import run as run_app


def test_the_command_needs_rig_data_or_walks(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["calibrate-slip"])
    with pytest.raises(SystemExit) as ended:
        run_app(app)
    assert ended.value.code == 2
    assert "missing: rig data" in capsys.readouterr().err
