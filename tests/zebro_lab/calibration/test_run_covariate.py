# SPDX-License-Identifier: MIT
"""Runs of several tables have one covariate; a fit by the command finds what it does."""

import tomllib

import numpy as np
import pytest

from model.slip.covariate import Covariate, CovariateLaw, law_at
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep
from support.commands import within_process
from support.rig_tables import columns, given_slip, write
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.calibration.run_covariate import levels
from zebro_lab.files.errors import SettingsError


def test_levels_are_values_apart():
    assert levels(np.array([5.0])).tolist() == [5.0]
    assert len(levels(np.array([300.0, 301.0, 330.0]))) == 2


def test_tables_state_the_same_covariate(tmp_path):
    tables = []
    for name, text in (
        ("a", "covariates.warmth = {value = 290}"), ("b", "covariates.warmth = {value = 320}"),
    ):  # fmt: skip
        columns(tmp_path / name, text)
        table = given_slip()
        table["traction_force"] *= 1.0 if name == "a" else 0.9
        tables.append(write(tmp_path / name, table))
    samples = read_rig_data(tables).samples
    assert samples.covariate is not None
    assert samples.covariate[1].tolist() == [290.0, 320.0]
    assert np.sign(samples.coordinate[[0, -1]]).tolist() == [-1, 1]
    columns(tmp_path / "b", "source = 'real'")
    with pytest.raises(SettingsError, match="states no warmth"):
        read_rig_data(tables)
    columns(tmp_path / "b", "covariates.warmth = {value = 320, reference = 300}")
    with pytest.raises(SettingsError, match="expected one covariate for all"):
        read_rig_data(tables)


def simulated(folder, growth):
    """Write a simulated sweep at two temperatures; friction grows by e^growth at the highest."""
    law = CovariateLaw(THESIS_LAW, Covariate("warmth", "K", 300.0, np.log(330 / 300)), 1)
    slips = (-0.3, -0.05, -0.02, 0.02, 0.05, 0.3)
    for number, warmth in enumerate((273.0, 330.0)):
        there = law_at(law, law.covariate.coordinate([warmth]))
        sweep = simulate_sweep(
            there, np.array([*THESIS_VALUES, growth, 0.0]),
            plan=SweepPlan(slips=slips, loads=(8.0,), rate=100.0), imperfections=TYPICAL_RIG,
            rng=np.random.default_rng(number),
        )  # fmt: skip
        path = folder / f"{warmth:g}"
        columns(
            path,
            f"constants.radius_leg = {SweepPlan().radius_leg}\n"
            f"constants.radius_ground = {SweepPlan().radius_ground}\n"
            f'source = "sim:rig"\ncovariates.warmth = {{value = {warmth}, unit = "K", '
            "reference = 300}",
        )
        import pandas as pd

        write(path, pd.DataFrame(sweep.table))
    return folder


@pytest.mark.parametrize("growth", [0.25, pytest.param(0.0, marks=pytest.mark.long)])
def test_calibrate_slip_finds_what_the_covariate_does_or_leaves_it_out(
    tmp_path, growth, monkeypatch, capsys
):
    data, out = simulated(tmp_path / "data", growth), tmp_path / "out"
    ended = within_process(monkeypatch, capsys)(
        "calibrate-slip", data, "--out", out, "--engine", "laplace", "--curvature", "peak"
    )
    told = ended.out
    assert ended.code == 0, ended.err
    content = tomllib.loads((out / "slip.toml").read_text())
    assert "warmth of runs: 273, 330 K" in told
    if growth:
        assert content["law"]["covariate"]["reference"] == 300
        found = content["parameters"]["friction_warmth"]
        assert abs(found["mean"] - growth) < 3 * found["sd"] < 0.1
        assert "at warmth 273, 330 K friction is " in told.replace("\n", " ")
    else:
        assert "covariate" not in content["law"]
    friction = content["parameters"]["friction"]
    assert abs(friction["mean"] - THESIS_VALUES[2]) < 3 * friction["sd"]
