# SPDX-License-Identifier: MIT
"""Check points tell whether the friction of a rig has drifted."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from zebro_lab.experiment.check_stage import check_runs
from zebro_lab.main import app

THESIS_PLAN = Path(__file__).parents[3] / "examples" / "plan-source.toml"


def zebro_lab(*arguments):
    return CliRunner().invoke(app, ["rig", *map(str, arguments)])


@pytest.fixture(name="plan")
def _plan(tmp_path):
    text = THESIS_PLAN.read_text()
    for old, new in {
        "loads = [2.13, 6.63, 8.13, 12.75]": "loads = [8.0]",
        "slips = { first = 0.0, last = 1.0, count = 62 }": "slips = [0.05, 0.6]",
        "duration = 1.0": "duration = 0.3",
        "tare_duration = 10.0": "tare_duration = 0.3",
        "check_every = 62": "check_every = 0",
        # A busy machine may hold a process up.
        "silence = 0.25": "silence = 3.0\nreading_age = 3.0\nguards_off = "
        '["silence", "reading_age", "speed_error_time"]',
        "speed_error_time = 0.2": "speed_error_time = 2.0",
    }.items():
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "plan.toml"
    file.write_text(text)
    return file


def test_a_rig_that_lost_friction_has_drifted(plan, tmp_path, monkeypatch):
    from dataclasses import replace

    from model.slip.thesis import thesis_curve
    from zebro_lab.experiment import check_stage as rig_check

    data = tmp_path / "data"
    assert zebro_lab("run", plan, "--rig", "sim", "--fast", "--data", data).exit_code == 0
    curve = thesis_curve()
    monkeypatch.setattr(rig_check, "read_slip", lambda path: curve)
    assert not any(found.drifted for found in check_runs([data], tmp_path))
    slippery = replace(curve, values=curve.values * np.array([1.0, 1.0, 0.6, 1.0]))
    monkeypatch.setattr(rig_check, "read_slip", lambda path: slippery)
    assert all(found.drifted for found in check_runs([data], tmp_path))
    result = zebro_lab("check", data, "--slip", tmp_path)
    assert result.exit_code == 3
    assert "2 of 2 runs have drifted" in result.output
