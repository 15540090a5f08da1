# SPDX-License-Identifier: MIT
"""Stages simulate and fit by the workers of a request, and write one folder, whole."""

import json

import pytest

from model.study.ranks import WRONG
from support.experiment_plans import short_plan
from support.made_studies import calibration_folder, coverage_of, ranks_of
from support.watchers import Nobody
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.study import stage
from zebro_lab.study.request import CoverageRequest, LayoutRequest, SbcRequest
from zebro_lab.study.stage import study_coverage, study_sbc
from zebro_lab.workers.request import WorkersRequest

pytestmark = pytest.mark.usefixtures("blank_pictures")
ONE = WorkersRequest(processes=1)


@pytest.fixture
def asked(monkeypatch):
    """Replace the fits by made-up ones; return what was asked for."""
    seen = []

    def ranked(study, task):
        seen.append((study, task))
        return ranks_of(study.fitted.free, n=3).replicates[task.index]

    def covered(study, task):
        seen.append((study, task))
        return coverage_of(study.design.free, n=1).replicates[0]

    monkeypatch.setattr(stage, "rank_replicate", ranked)
    monkeypatch.setattr(stage, "coverage_replicate", covered)
    monkeypatch.setattr(stage, "sweep_replicate", covered)
    return seen


def test_sbc_of_a_plan_writes_verdict_and_settings(tmp_path, asked):
    request = SbcRequest(
        LayoutRequest(plan=short_plan(tmp_path)), law="coulomb-stribeck", wrong="perfect-rig",
        replicates=3, seed=8, workers=ONE, out=tmp_path / "out",
    )  # fmt: skip
    watcher = Nobody()
    studied = study_sbc(request, watcher)
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    assert manifest["kind"] == "study-sbc"
    assert manifest["source"] == "sim:study"
    assert manifest["verdict"]["outcome"] == "not_testable"
    assert manifest["settings"]["wrong"] == "perfect-rig"
    assert set(manifest["settings"]["priors"]) >= {"friction", "radius_error"}
    assert list(manifest["inputs"]) == [str(tmp_path / "plan.toml")]
    assert "WRONG on purpose: perfect-rig" in studied.title
    assert [(task.seed, task.index) for _, task in asked] == [(8, 0), (8, 1), (8, 2)]
    study = asked[0][0]
    assert set(study.design.free) - set(study.fitted.free) == set(WRONG["perfect-rig"])
    assert ("replicates", 1.0) in watcher.seen


def test_coverage_of_a_calibration_has_its_mean_for_truth(tmp_path, asked):
    folder = calibration_folder(tmp_path / "mine")
    request = CoverageRequest(
        LayoutRequest(calibration=folder), replicates=2, workers=ONE, out=tmp_path / "out"
    )
    studied = study_coverage(request, Nobody())
    assert studied.title == "data of mine, law 'magic-formula', truth: its posterior mean"
    assert 0.3 < asked[0][0].truth["friction"] < 0.5
    assert {"parameters.csv", "replicates.csv", "coverage.png", "manifest.json"} == {
        path.name for path in (tmp_path / "out").iterdir()
    }


def test_coverage_of_a_plan_takes_another_calibrations_mean(tmp_path, asked):
    folder = calibration_folder(tmp_path / "mine")
    request = CoverageRequest(
        LayoutRequest(plan=short_plan(tmp_path)), truth=folder, replicates=1, workers=ONE,
        out=tmp_path / "out",
    )  # fmt: skip
    assert study_coverage(request, Nobody()).title.endswith("truth: mean of mine")
    assert asked[0][0].plan.loads == (8.0,)


def test_a_truth_of_other_slip_is_wrong_usage(tmp_path, asked):
    folder = calibration_folder(tmp_path / "mine")
    text = (folder / "slip.toml").read_text()
    (folder / "slip.toml").write_text(text.replace('"material"', '"travel"'))
    request = CoverageRequest(truth=folder, workers=ONE, out=tmp_path / "out")
    with pytest.raises(SettingsError, match=r"--truth: .* is of 'travel' slip"):
        study_coverage(request, Nobody())
    assert not asked


def test_a_folder_of_another_command_is_refused_before_any_fit(tmp_path, asked):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "manifest.json").write_text('{"kind": "walk", "outputs": {}}')
    with pytest.raises(AlreadyExists, match="another command"):
        study_sbc(SbcRequest(workers=ONE, out=tmp_path / "out"), Nobody())
    assert not asked
