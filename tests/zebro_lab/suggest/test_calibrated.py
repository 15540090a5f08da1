# SPDX-License-Identifier: MIT
"""Further runs are weighed with the blocks, law and priors that a calibration was fitted with."""

import json

import pytest

from model.bayes.priors import Normal
from support.short_calibration import calibration_folder, short_calibration
from zebro_lab.files.errors import DataError
from zebro_lab.suggest.calibrated import read_calibrated


def test_a_calibration_gives_its_blocks_law_and_priors(tmp_path):
    calibration = short_calibration()
    folder = calibration_folder(
        tmp_path / "mine", priors={"stated": {"friction": "friction = 0.4 ± 0.05"}}
    )
    found = read_calibrated(folder).posterior
    assert found.law == calibration.posterior.law
    assert found.blocks.n_runs == calibration.posterior.blocks.n_runs
    assert found.priors["friction"] == Normal(0.4, 0.05)
    assert found.priors["crosstalk"] == calibration.posterior.priors["crosstalk"]


def test_the_prior_of_an_earlier_calibration_is_left_out_and_told(tmp_path):
    folder = calibration_folder(tmp_path / "mine", priors={"from": {"calibration": "old"}})
    assert any("--prior-from is left out" in note for note in read_calibrated(folder).notes)


def test_student_t_noise_is_left_out_and_told(tmp_path):
    folder = calibration_folder(tmp_path / "mine")
    with (folder / "slip.toml").open("a") as file:
        file.write('\n[noise]\ndistribution = "student"\n')
    assert any("Student-t noise is left out" in note for note in read_calibrated(folder).notes)


@pytest.mark.parametrize(
    ("settings", "problem"),
    [
        ({}, r"has no settings\.load_cell; calibrate again"),
        ({"load_cell": {"gain_sd": "much"}}, r"settings\.load_cell cannot be read"),
    ],
)
def test_a_calibration_without_its_load_cell_is_damaged(tmp_path, settings, problem):
    folder = calibration_folder(tmp_path / "mine")
    (folder / "manifest.json").write_text(json.dumps({"settings": settings}))
    with pytest.raises(DataError, match=problem):
        read_calibrated(folder)
