# SPDX-License-Identifier: MIT
"""A leg log leads where the gait that wrote it led."""

import numpy as np
import pandas as pd
import pytest

from model.walk_models import MODELS
from support.walk_requests import request, write_log
from support.watchers import Nobody
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.folder import read_walk_manifest
from zebro_lab.walk.output_request import BandRequest
from zebro_lab.walk.predict_stage import predict
from zebro_lab.walk.request import ModelRequest, PredictRequest
from zebro_lab.walk.stage import walk
from zebro_lab.walk.summary import summarise


@pytest.mark.parametrize("model", MODELS)
def test_right_turn_mirrors_the_left_one_in_its_log(model, tmp_path):
    ends = []
    for side in ("left", "right"):
        log = write_log(tmp_path, direction=side)
        asked = ModelRequest(slip="coulomb:0.4", model=model)
        wanted = PredictRequest(log, tmp_path / side, direction=side, model=asked)
        ends.append(summarise(predict(wanted, Nobody()).path))
    assert np.sign(ends[0].yaw_rate) == 1
    assert np.sign(ends[1].yaw_rate) == -1


def test_predicting_a_gaits_own_log_walks_the_gait(tmp_path):
    walked = walk(request(tmp_path / "walk"), Nobody()).path
    log = write_log(tmp_path, start=100.0)
    predicted = predict(
        PredictRequest(log, tmp_path / "predicted", model=ModelRequest(slip="coulomb:0.4")),
        Nobody(),
    ).path
    assert predicted.t[0] == 100.0
    np.testing.assert_allclose(predicted.t - 100, walked.t, atol=1e-9)
    # the log has straight lines across the instants at which legs change speed
    np.testing.assert_allclose(predicted.position, walked.position, atol=1e-3)


@pytest.mark.parametrize("name", ["walk", "walk/path.csv"])
def test_walked_path_leads_where_it_led_though_legs_are_offset(name, tmp_path):
    robot = tmp_path / "robot.toml"
    robot.write_text("[legs]\noffset_deg = [0, 0, -5, 0, 0, 0]\nsign = [-1, 1, 1, 1, 1, 1]\n")
    walked = walk(request(tmp_path / "walk", robot=robot), Nobody()).path
    asked = ModelRequest(slip="coulomb:0.4", robot=robot)
    again = predict(PredictRequest(tmp_path / name, tmp_path / "again", model=asked), Nobody()).path
    np.testing.assert_allclose(again.theta, walked.theta, atol=1e-9)
    np.testing.assert_allclose(again.position, walked.position, atol=1e-6)


def test_robot_file_changes_robot_and_reading_of_the_log(tmp_path):
    robot = tmp_path / "robot.toml"
    robot.write_text("mass = 3.0\n[legs]\nsign = [-1, -1, -1, -1, -1, -1]\n")
    plain = predict(
        PredictRequest(write_log(tmp_path), tmp_path / "a", model=ModelRequest(slip="coulomb:0.4")),
        Nobody(),
    )
    signed = predict(
        PredictRequest(
            write_log(tmp_path, sign=-1),
            tmp_path / "b",
            model=ModelRequest(slip="coulomb:0.4", robot=robot),
        ),
        Nobody(),
    )
    np.testing.assert_allclose(signed.path.position, plain.path.position, atol=2e-3)
    load = signed.path.normal_force[250].sum() / plain.path.normal_force[250].sum()
    assert load == pytest.approx(3.0 / 2.17, rel=0.01)
    manifest = read_walk_manifest(tmp_path / "b")
    assert manifest["settings"]["robot"]["mass"] == 3.0
    assert set(manifest["inputs"]) == {str(tmp_path / "legs.csv"), str(robot)}


@pytest.mark.reference
def test_log_of_the_virtual_world_leads_where_its_robot_went(shared, tmp_path):
    name = "tripod_s1.30_left_mu0.38_tc2_arc200real.csv.gz"
    columns = tmp_path / "columns.toml"
    columns.write_text(
        'source = "sim:virtual-world"\n[columns]\n'
        + "".join(f'theta{leg} = "th{leg}"\n' for leg in range(1, 7))
    )
    truth = pd.read_csv(shared / "virtual-world" / "walks" / name)
    robot = tmp_path / "robot.toml"
    robot.write_text("[legs]\narc_deg = 200\n")
    walked = predict(
        PredictRequest(
            shared / "virtual-world" / "walks" / name,
            tmp_path / "out",
            model=ModelRequest(slip="coulomb:0.38:0.001", robot=robot),
            columns=columns,
        ),
        Nobody(),
    )
    x, y = (np.interp(truth.t, walked.path.t, walked.path.position[:, i]) for i in (0, 1))
    error = np.sqrt(np.mean((x - truth.x) ** 2 + (y - truth.y) ** 2))
    assert error < 0.01 * walked.path.length
    assert summarise(walked.path).radius == pytest.approx(1.5295, rel=0.02)
    assert "simulated leg angles" in walked.title


def test_a_wrong_order_of_legs_is_suspected_in_the_notes(tmp_path):
    log = write_log(tmp_path)
    table = pd.read_csv(log)
    swapped = {f"theta{i + 1}": table[f"theta{leg}"] for i, leg in enumerate((1, 3, 5, 2, 4, 6))}
    table.assign(**swapped).to_csv(log, index=False)
    model = ModelRequest(model="no-slip-simple")
    notes = predict(PredictRequest(log, tmp_path / "out", model=model), Nobody()).notes
    assert any(note.startswith("WARNING: leg log: legs step in the groups") for note in notes)


def test_a_band_needs_the_model_that_has_one(tmp_path):
    model = ModelRequest(model="no-slip", band=BandRequest(10))
    with pytest.raises(SettingsError, match="dynamics"):
        predict(PredictRequest(write_log(tmp_path), tmp_path / "out", model=model), Nobody())
