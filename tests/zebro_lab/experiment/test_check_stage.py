# SPDX-License-Identifier: MIT
"""Check points tell whether the friction of a rig has drifted."""

import numpy as np
import pytest
from typer.testing import CliRunner

from support.experiment_plans import short_plan
from zebro_lab.experiment.check_stage import check_runs
from zebro_lab.main import app


def zebro_lab(*arguments):
    return CliRunner().invoke(app, ["rig", *map(str, arguments)])


@pytest.fixture(name="plan")
def _plan(tmp_path):
    return short_plan(tmp_path)


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
    assert "2 of 2 runs deviate from the calibration" in result.output
