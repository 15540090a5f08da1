# SPDX-License-Identifier: MIT
"""A prediction is read with its draws and with baselines for its leg angles."""

import json

import numpy as np
import pandas as pd
import pytest

from model.gait import tetrapod_reference
from model.walk_fit.prior import WrongLeg
from support.validated_walks import predicted
from support.walk_posteriors import posterior_of, predict_log, stored
from zebro_lab.files.errors import DataError
from zebro_lab.walk.prediction_file import read_prediction


def test_a_gait_that_a_baseline_cannot_walk_is_judged_without_it(tmp_path):
    t = np.arange(0.0, 4.0, 0.01)
    reference = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    legs = pd.DataFrame(
        {"t": t} | {f"theta{i + 1}": a for i, a in enumerate(reference.angles(t).T)}
    )
    legs.to_csv(tmp_path / "legs.csv", index=False)
    prediction = read_prediction(predicted(tmp_path, tmp_path / "legs.csv", draws=0))
    assert set(prediction.prediction.baselines) == {"no-slip-simple", "no-slip"}
    assert any("'thesis' cannot walk" in note for note in prediction.notes)


def test_baselines_know_the_legs_as_described_not_as_fitted(calibration, legs, tmp_path):
    predict_log(tmp_path, legs[0], str(calibration), name="plain")
    stored(calibration, legs, posterior_of(WrongLeg(2)))
    predict_log(tmp_path, legs[0], str(calibration), name="fitted")
    plain, fitted = (
        read_prediction(tmp_path / name).prediction.baselines for name in ("plain", "fitted")
    )
    for name in ("no-slip", "no-slip-simple"):
        np.testing.assert_allclose(plain[name].position, fitted[name].position, atol=1e-6)


def test_a_table_of_poses_has_no_baseline_but_the_robot_that_stands_still(tmp_path):
    (tmp_path / "poses.csv").write_text("t,x,y,yaw\n0,0,0,0\n1,0.1,0,0\n2,0.2,0,0\n")
    found = read_prediction(tmp_path / "poses.csv")
    np.testing.assert_array_equal(found.prediction.path.position[:, 0], [0.0, 0.1, 0.2])
    assert (found.walk, found.sources) == (None, ("unknown",))
    assert "is the only baseline" in found.notes[0]
    assert found.files == (tmp_path / "poses.csv",)


def test_a_manifest_without_the_robot_is_one_line(legs, tmp_path):
    folder = predicted(tmp_path, legs[0], draws=0)
    manifest = folder / "manifest.json"
    content = json.loads(manifest.read_text())
    del content["settings"]["robot"]["hips"]
    manifest.write_text(json.dumps(content))
    with pytest.raises(DataError, match=r"manifest\.json: settings\.robot is .* \('hips'\)"):
        read_prediction(folder)
