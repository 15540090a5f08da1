# SPDX-License-Identifier: MIT
"""Priors of options, `columns.toml` and an earlier calibration come to one."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from model.bayes.prior_conflict import PriorShift
from model.bayes.stated_priors import StatedPriors
from model.slip import MagicFormula
from model.slip.thesis_curve import THESIS_LAW
from support.compared_folders import calibration
from support.rig_tables import RADII, columns, louder, speeds, write
from support.short_calibration import short_calibration
from zebro_lab.calibration.folder import write_tables
from zebro_lab.calibration.priors import KnownPriors, gather_priors, priors_content, read_earlier
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.provenance import file_hash

LAWS = {"constant": MagicFormula("constant"), "peak": THESIS_LAW}


@pytest.fixture
def earlier(tmp_path) -> Path:
    folder = tmp_path / "last-year"
    folder.mkdir()
    write_tables(folder, short_calibration(), inputs={})
    return folder


def data(folder: Path, priors: str = "") -> RigData:
    columns(folder, f"{RADII}{priors}")
    return read_rig_data([write(folder, speeds())])


def test_an_option_replaces_the_prior_of_columns_toml_by_the_parameter_s_name(tmp_path):
    found = data(tmp_path, '[priors]\nfriction = "0.4 ± 0.1"\nshape = "uniform(1.4, 1.7)"\n')
    request = CalibrationRequest((tmp_path,), prior=("mu = 0.5 ± 0.2",))
    stated, laws = gather_priors(request, found, LAWS)
    assert stated.texts == {"friction": "mu = 0.5 ± 0.2", "shape": "shape ~ uniform(1.4, 1.7)"}
    assert "normal(mean 0.5, sd 0.2)" in stated.priors.single["friction"].describe()
    assert laws is LAWS


def test_a_wrong_prior_of_columns_toml_names_the_file(tmp_path):
    found = data(tmp_path, '[priors]\nfrction = "0.4 ± 0.1"\n')
    with pytest.raises(SettingsError, match=r"columns\.toml, \[priors\].*did you mean 'friction'"):
        gather_priors(CalibrationRequest((tmp_path,)), found, LAWS)


def test_different_priors_of_two_column_maps_are_refused(tmp_path):
    paths = []
    for name, sd in (("a", 0.1), ("b", 0.2)):
        folder = tmp_path / name
        columns(folder, f'{RADII}[priors]\nfriction = "0.4 ± {sd}"\n')
        paths.append(write(folder, speeds() if name == "a" else louder(speeds())))
    with pytest.raises(SettingsError, match="differs from that of"):
        read_rig_data(paths)


def test_an_earlier_calibration_brings_its_law_and_block_length(tmp_path, earlier):
    request = CalibrationRequest((tmp_path,), prior_from=earlier)
    stated, laws = gather_priors(request, data(tmp_path / "data"), LAWS)
    fitted = short_calibration()
    assert list(laws.values()) == [fitted.posterior.law]
    assert stated.block_length == fitted.fit.block_choice.length
    assert any("'magic-formula'" in note for note in stated.notes)
    carried = stated.priors.earlier.draws
    assert set(carried) == {p.name for p in fitted.posterior.free}
    assert {path.name for path in stated.files} == {"slip.toml", "posterior.nc"}


def test_another_load_cell_leaves_out_what_it_changes(tmp_path, earlier):
    request = CalibrationRequest((tmp_path,), prior_from=earlier)
    found, law = data(tmp_path / "data"), {p.name for p in THESIS_LAW.parameters}
    other_cell, _ = gather_priors(replace(request, carry="law"), found, LAWS)
    assert set(other_cell.priors.earlier.draws) == law


def test_data_of_the_earlier_calibration_are_not_counted_twice(tmp_path):
    found, folder = data(tmp_path / "data"), tmp_path / "last-year"
    folder.mkdir()
    table = next(file for file in found.files if file.suffix == ".csv")
    for file in (table, found.priors_file or table.with_name("columns.toml")):
        write_tables(folder, short_calibration(), inputs={str(file): file_hash(file)})
        request = CalibrationRequest((tmp_path,), prior_from=folder)
        if file == table:
            with pytest.raises(SettingsError, match=r"rig\.csv: already in the data of last-year"):
                gather_priors(request, found, LAWS)
        else:  # the same column map is no reason
            gather_priors(request, found, LAWS)


def test_an_earlier_calibration_of_another_law_is_refused(tmp_path, earlier):
    request = CalibrationRequest((tmp_path,), prior_from=earlier, law="brush")
    with pytest.raises(SettingsError, match="was fitted with the law 'magic-formula'"):
        gather_priors(request, data(tmp_path / "data"), LAWS)


def test_an_earlier_calibration_of_another_slip_definition_is_refused(tmp_path, earlier):
    columns(tmp_path / "data", RADII)
    found = read_rig_data([write(tmp_path / "data", speeds())], slip_definition="travel")
    with pytest.raises(SettingsError, match="add --slip-definition material"):
        gather_priors(CalibrationRequest((tmp_path,), prior_from=earlier), found, LAWS)


def test_what_was_stated_is_recorded_with_how_the_data_agree():
    shifts = (
        PriorShift(("friction",), np.array([-4.2]), 18.1, 1, 2e-5),
        PriorShift(("gain_normal",), np.array([0.1]), 0.0, 0, float("nan")),
    )
    stated = KnownPriors(StatedPriors(), {"friction": "friction = 0.4 ± 0.05"})
    assert priors_content(stated, short_calibration()) == {}
    content = priors_content(stated, replace(short_calibration(), prior_shifts=shifts))
    assert content["stated"] == {"friction": "friction = 0.4 ± 0.05"}
    conflict, silent = content["agreement"]
    assert (conflict["conflict"], conflict["p"]) == (True, 2e-5)
    assert conflict["shift_in_prior_sd"] == [-4.2]
    assert "p" not in silent
    assert "from" not in content


def test_simulated_and_untrustworthy_priors_are_said(tmp_path):
    write_tables(tmp_path, short_calibration(), inputs={})
    warned, simulated = read_earlier(tmp_path).notes
    assert "not trustworthy: the sampler did not converge" in warned
    assert "SIMULATED data, source 'sim:test'" in simulated


def test_a_slip_toml_without_draws_is_no_posterior(tmp_path):
    with pytest.raises(NotFound, match=r"posterior\.nc: no such file"):
        read_earlier(calibration(tmp_path / "slip"))
