# SPDX-License-Identifier: MIT
"""Check points tell whether the friction of a rig has drifted."""

from pathlib import Path

import numpy as np
from typer.testing import CliRunner

from zebro_lab.calibration.folder import SlipFile
from zebro_lab.experiment.check_stage import check_runs
from zebro_lab.main import app


def zebro_lab(*arguments):
    return CliRunner().invoke(app, ["rig", *map(str, arguments)])


def stated(curve):
    return SlipFile(curve, Path("slip.toml"), "real", None)


def test_a_rig_that_lost_friction_has_drifted(short, tmp_path, monkeypatch):
    from dataclasses import replace

    from model.slip.thesis_curve import thesis_curve
    from zebro_lab.experiment import check_stage as rig_check

    data = tmp_path / "data"
    assert zebro_lab("run", short, "--rig", "sim", "--fast", "--data", data).exit_code == 0
    curve = thesis_curve()
    monkeypatch.setattr(rig_check, "read_slip_file", lambda path: stated(curve))
    assert not any(found.verdict for found in check_runs([data], tmp_path).runs)
    slippery = replace(curve, values=curve.values * np.array([1.0, 1.0, 0.6, 1.0]))
    monkeypatch.setattr(rig_check, "read_slip_file", lambda path: stated(slippery))
    assert {found.verdict for found in check_runs([data], tmp_path).runs} == {"DRIFTED"}
    result = zebro_lab("check", data, "--slip", tmp_path)
    assert result.exit_code == 3
    assert "2 of 2 runs deviate from the calibration" in result.output


def test_a_run_of_a_few_samples_is_not_testable_and_not_passed(tmp_path, monkeypatch):
    from model.slip.thesis_curve import thesis_curve
    from zebro_lab.experiment import check_stage as rig_check

    curve = thesis_curve()
    monkeypatch.setattr(rig_check, "read_slip_file", lambda path: stated(curve))
    data = tmp_path / "data"
    data.mkdir()
    for name, n in (("many", 50), ("few", 5)):
        slip = np.linspace(0.1, 0.2, n)
        force = curve.force(slip, 8.0, definition=curve.definition)
        rows = np.column_stack([np.arange(n), slip, np.full(n, 8.0), force])
        names = "t,slip_ratio,normal_force,traction_force"
        np.savetxt(data / f"{name}.csv", rows, delimiter=",", header=names, comments="")
    (data / "columns.toml").write_text('[columns.slip_ratio]\ndefinition = "material"\n')
    result = zebro_lab("check", data, "--slip", tmp_path)
    few, many, _ = sorted(result.output.splitlines(), key=lambda line: "NOT" not in line)
    assert few.startswith("few: ")
    assert few.endswith("NOT TESTABLE: fewer than 8 samples")
    assert many.startswith("many: ")
    assert result.exit_code == 3
