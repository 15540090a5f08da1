# SPDX-License-Identifier: MIT
"""What `import zebro_lab` offers, used as a notebook would."""

import inspect
from pathlib import Path

import numpy as np
import pytest

import zebro_lab as zl
from zebro_lab.files.errors import AlreadyExists, ZebroLabError

DATASETS = Path(__file__).parents[2] / "datasets"
WALK = DATASETS / "walk-sim"


@pytest.fixture(scope="module")
def walk_folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("walk") / "walk"
    zl.walk_gait("tripod", slip="coulomb:0.38", duration=4.0, steering=1.2, draws=5, out=str(out))
    return out


def test_every_name_is_offered_and_documented():
    assert dir(zl) == sorted(zl.__all__)
    for name in zl.__all__:
        if name != "__version__":
            assert inspect.getdoc(getattr(zl, name))
    with pytest.raises(AttributeError, match="no attribute 'walkgait'"):
        _ = zl.walkgait


def test_parameters_of_public_functions_are_typed_and_described():
    for name in zl.__all__:
        function = getattr(zl, name)
        if not inspect.isfunction(function):
            continue
        for parameter in inspect.signature(function).parameters.values():
            assert parameter.annotation is not inspect.Parameter.empty
            assert f"{parameter.name}:" in (inspect.getdoc(function) or ""), (name, parameter.name)


def test_a_gait_is_walked_without_a_folder():
    result = zl.walk_gait("tripod", slip="coulomb:0.38", duration=2.0)
    assert result.path.length > 0.1
    assert result.draws is None


def test_a_walk_with_draws_is_kept_where_asked(walk_folder):
    assert (walk_folder / "manifest.json").is_file()
    again = zl.predict_walk(walk_folder, slip="coulomb:0.38", draws=5)
    assert again.draws is not None
    assert again.draws.states.shape[0] == 5
    end = zl.read_track(walk_folder / "path.csv").poses.position[-1]
    assert np.linalg.norm(again.path.position[-1] - end) < 0.02


def test_a_prediction_is_validated_against_a_track(walk_folder):
    done = zl.validate_walks((walk_folder, WALK / "truth.csv"))
    rows = {row.name: row.errors.ate for row in done.runs[0].rows}
    assert rows["prediction"] < rows["stand still"]


def test_a_calibration_has_summary_posterior_verdict_and_curve(sweep):
    result = zl.calibrate(str(sweep), ensembles=2, max_steps=500)
    assert {"mean", "sd", "r_hat"} <= set(result.summary.columns)
    assert "friction" in result.posterior.posterior
    assert result.verdict.headline()
    assert result.curve.values[2] == pytest.approx(0.38, abs=0.1)
    assert result.data.source.startswith("sim:")


def test_rig_data_and_legs_are_read_from_strings():
    data = zl.read_rig_data(str(DATASETS / "rig-sim"))
    assert len(data.samples.slip) > 1000
    assert zl.read_legs(str(WALK / "legs.csv")).reference.theta.shape[1] == 6


def test_twins_are_opened_and_read():
    with zl.open_devices(zebro="sim") as devices:
        (legs,) = devices.devices
        samples = [legs.stream.read(timeout=1.0) for _ in range(3)]
    assert any(samples)


def test_files_of_others_are_kept(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(AlreadyExists):
        zl.walk_gait("tripod", slip="coulomb:0.4", duration=1.0, out=tmp_path / "mine.txt")
    assert (tmp_path / "mine.txt").read_text() == "mine"


def test_a_missing_run_is_said(tmp_path):
    with pytest.raises(ZebroLabError):
        zl.open_run(tmp_path / "nothing")
