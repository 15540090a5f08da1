# SPDX-License-Identifier: MIT
"""A layout is that of a plan, measured by the simulated rig, or of a calibration's own data."""

import json

import numpy as np
import pytest

from model.bayes.priors import Normal
from model.slip.thesis import THESIS_LAW
from support.experiment_plans import short_plan
from support.made_studies import calibration_folder
from support.short_calibration import short_calibration
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.study.layout import read_layout
from zebro_lab.study.request import LayoutRequest


def planned(folder, *replacements):
    file = short_plan(folder)
    text = file.read_text()
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    file.write_text(text)
    return read_layout(LayoutRequest(plan=file), THESIS_LAW)


def test_a_plans_points_are_the_runs(tmp_path):
    found = planned(
        tmp_path,
        ("slips = [0.05, 0.6]", "slips = [-0.2, 0.05, 0.6]"),
        ("loads = [8.0]", "loads = [8.0, 3.0]"),
        ('order = "monotone"', 'order = "up-down"'),
    )  # fmt: skip
    blocks = found.design.blocks
    assert found.title == "plan 'thesis 4 x 62'"
    assert found.plan.slips == (-0.2, 0.05, 0.6, 0.05, -0.2)
    assert blocks.n_runs == 10
    assert blocks.slip.min() == pytest.approx(-0.2, abs=0.02)
    assert set(np.round(blocks.run_mean(blocks.normal_force)).tolist()) >= {3.0, 8.0}
    assert found.files == (tmp_path / "plan.toml",)


def test_a_gliding_sweep_is_refused(tmp_path):
    with pytest.raises(SettingsError, match=r"points\.sweep: glides"):
        planned(tmp_path, ("# sweep = true", "sweep = true"))


def test_a_plan_of_too_many_samples_is_refused(tmp_path):
    with pytest.raises(SettingsError, match="expected at most 2e\\+06 for a study"):
        planned(tmp_path, ("duration = 0.3", "duration = 5000.0"))


def test_a_calibration_gives_its_blocks_law_priors_and_means(tmp_path):
    calibration = short_calibration()
    prior = ("bias_normal = 0.1 +/- 0.02",)
    folder = calibration_folder(
        tmp_path / "mine", priors={"stated": {"friction": "friction = 0.4 ± 0.05"}}
    )
    found = read_layout(LayoutRequest(calibration=folder, prior=prior), THESIS_LAW)
    posterior = calibration.posterior
    assert found.title == "data of mine"
    assert found.design.law == posterior.law
    assert found.design.blocks.n_runs == posterior.blocks.n_runs
    assert found.design.priors["friction"] == Normal(0.4, 0.05)
    assert found.design.priors["bias_normal"] == Normal(0.1, 0.02)
    assert found.design.priors["crosstalk"] == posterior.priors["crosstalk"]
    assert found.mean["friction"] == pytest.approx(calibration.parameters[2].mean)


def test_the_prior_of_an_earlier_calibration_is_left_out_and_told(tmp_path):
    folder = calibration_folder(tmp_path / "mine", priors={"from": {"calibration": "old"}})
    found = read_layout(LayoutRequest(calibration=folder), THESIS_LAW)
    assert any("--prior-from is left out" in note for note in found.notes)


def test_student_t_noise_is_left_out_and_told(tmp_path):
    folder = calibration_folder(tmp_path / "mine")
    with (folder / "slip.toml").open("a") as file:
        file.write('\n[noise]\ndistribution = "student"\n')
    found = read_layout(LayoutRequest(calibration=folder), THESIS_LAW)
    assert any("Student-t noise is left out" in note for note in found.notes)


def test_a_calibration_without_its_load_cell_is_damaged(tmp_path):
    folder = calibration_folder(tmp_path / "mine")
    (folder / "manifest.json").write_text(json.dumps({"settings": {}}))
    with pytest.raises(DataError, match=r"has no settings\.load_cell; calibrate again"):
        read_layout(LayoutRequest(calibration=folder), THESIS_LAW)


def test_a_load_cell_that_is_no_table_of_numbers_is_damaged(tmp_path):
    folder = calibration_folder(tmp_path / "mine", load_cell={"gain_sd": "much"})
    with pytest.raises(DataError, match=r"settings\.load_cell cannot be read"):
        read_layout(LayoutRequest(calibration=folder), THESIS_LAW)


def test_a_calibration_without_means_of_the_measurement_is_damaged(tmp_path):
    folder = calibration_folder(tmp_path / "mine")
    text = (folder / "slip.toml").read_text()
    (folder / "slip.toml").write_text(text.replace("[parameters.crosstalk]", "[parameters.other]"))
    with pytest.raises(DataError, match="has no mean of crosstalk"):
        read_layout(LayoutRequest(calibration=folder), THESIS_LAW)
