# SPDX-License-Identifier: MIT
"""From a gait or a leg log to a finished walk folder."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from model.errors import DomainError
from model.gait import tripod_angles, tripod_reference
from model.walk_models import MODELS
from support.watchers import Impatient, Nobody
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.robot.gait_request import GaitRequest
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.robot.robot_file import read_robot_file
from zebro_lab.walk.folder import PICTURES, read_walk, read_walk_manifest
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.path_band import read_draws
from zebro_lab.walk.predict_stage import predict
from zebro_lab.walk.request import BandRequest, ModelRequest, PredictRequest, WalkRequest
from zebro_lab.walk.stage import walk, write_robot
from zebro_lab.walk.summary import summarise


def request(out, **model) -> WalkRequest:
    gait = GaitRequest(steering=1.3, direction="left")
    return WalkRequest(gait, 4.0, out, ModelRequest(**{"slip": "coulomb:0.4", **model}))


def write_log(folder, *, start=0.0, sign=1, **gait):
    reference = tripod_reference(tripod_angles(np.radians(50), 1.3), 2.0, **gait)
    t = np.linspace(0, 4, 801)
    table = pd.DataFrame(sign * reference.angles(t) % (2 * np.pi), columns=list(ANGLES))
    table.insert(0, "t", t + start)
    table.to_csv(folder / "legs.csv", index=False)
    return folder / "legs.csv"


def test_a_gait_has_a_band_around_its_path(tmp_path):
    asked = request(tmp_path / "out", dt=0.005, band=BandRequest(12, offset_sd_deg=1.0))
    walked = walk(asked, Nobody())
    draws = read_draws(tmp_path / "out")
    assert draws.position.shape[0] == 12
    end, spread = draws.position[:, -1], draws.position[:, -1].std(axis=0)
    assert np.all(np.abs(end.mean(axis=0) - walked.path.position[-1, :2]) < 3 * spread)
    assert np.all(spread > 1e-4)
    assert read_walk_manifest(tmp_path / "out")["settings"]["band"]["draws"] == 12


def test_a_gait_walked_by_a_model_without_a_band_is_refused_and_leaves_nothing(tmp_path):
    asked = request(tmp_path / "out", model="no-slip", band=BandRequest(12))
    with pytest.raises(SettingsError, match="dynamics"):
        walk(asked, Nobody())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("model", MODELS)
def test_every_model_walks_and_its_path_is_read_back(model, tmp_path):
    walked = walk(request(tmp_path / "out", model=model), Nobody())
    path = read_walk(tmp_path / "out")
    np.testing.assert_allclose(path.position, walked.path.position, rtol=1e-9, atol=1e-12)
    manifest = read_walk_manifest(tmp_path / "out")
    assert manifest["source"] == f"sim:{model}"
    assert manifest["settings"]["gait"] == {"name": "tripod", "steering": 1.3, "direction": "left"}
    assert manifest["settings"]["dt"] == walked.dt == MODELS[model].dt
    assert summarise(path).radius > 0
    assert (", slip " in walked.title) == MODELS[model].slips


@pytest.mark.parametrize("model", MODELS)
def test_right_turn_mirrors_the_left_one_in_its_log(model, tmp_path):
    ends = []
    for side in ("left", "right"):
        log = write_log(tmp_path, direction=side)
        asked = ModelRequest(slip="coulomb:0.4", model=model)
        ends.append(
            summarise(
                predict(
                    PredictRequest(log, tmp_path / side, direction=side, model=asked), Nobody()
                ).path
            )
        )
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


def test_arc_is_that_asked_for(tmp_path):
    walked = walk(request(tmp_path / "out", arc_deg=200.0), Nobody())
    assert walked.described.robot.leg_arc == pytest.approx(np.radians(200))
    with pytest.raises(SettingsError, match="--arc-deg"):
        walk(request(tmp_path / "bad", arc_deg=20.0), Nobody())


def test_pictures_come_when_asked_for_and_say_simulated(tmp_path):
    watcher = Nobody()
    walk(request(tmp_path / "out", figures=True), watcher)
    names = {f"{name}.png" for name in PICTURES}
    assert {p.name for p in (tmp_path / "out").iterdir()} == names | {"path.csv", "manifest.json"}
    assert [what for what, _ in watcher.seen] == ["walking", "drawing"]


def test_film_comes_when_asked_for(tmp_path):
    watcher = Nobody()
    walk(replace(request(tmp_path / "out", animate=True), duration=0.2), watcher)
    assert len(list((tmp_path / "out").glob("animation.*"))) == 1
    assert watcher.seen[-1] == ("filming", 1.0)


def test_stopped_walk_leaves_nothing_behind(tmp_path):
    with pytest.raises(WalkStopped, match="nothing was written"):
        walk(request(tmp_path / "out", figures=True), Impatient())
    assert list(tmp_path.iterdir()) == []


def test_model_that_slips_needs_a_law_and_one_that_does_not_says_so(tmp_path):
    with pytest.raises(SettingsError, match="--slip: missing"):
        walk(request(tmp_path / "out", slip=None), Nobody())
    walked = walk(request(tmp_path / "out", model="no-slip"), Nobody())
    assert "--slip coulomb:0.4 not used" in walked.notes[0]


@pytest.mark.parametrize("bad", [{"dt": 0.0}, {"dt": -1.0}, {"dt": float("nan")}, {"dt": 100.0}])
def test_step_longer_than_the_walk_is_refused(bad, tmp_path):
    with pytest.raises((SettingsError, DomainError)):
        walk(request(tmp_path / "out", **bad), Nobody())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("model", MODELS)
def test_a_walk_of_more_steps_than_memory_holds_is_refused(model, tmp_path):
    endless = replace(request(tmp_path / "out", model=model), duration=1e12)
    with pytest.raises(SettingsError, match=r"1e\+12 s in steps of .* at most 500,000 are walked"):
        walk(endless, Nobody())
    with pytest.raises(SettingsError, match=r"2e-06 s is 2e\+06 steps; .* lengthen --dt"):
        walk(request(tmp_path / "out", model=model, dt=2e-6), Nobody())
    assert not (tmp_path / "out").exists()


def test_robot_written_out_is_the_robot_asked_for(tmp_path):
    file = write_robot(tmp_path / "robot.toml", ModelRequest(arc_deg=200.0))
    assert np.degrees(read_robot_file(file).robot.leg_arc) == pytest.approx(200)
    with pytest.raises(AlreadyExists, match="edit it, or name another"):
        write_robot(file, ModelRequest())


@pytest.mark.reference
def test_log_of_the_virtual_world_leads_where_its_robot_went(shared, tmp_path):
    name = "tripod_s1.30_left_mu0.38_tc2_arc200real.csv.gz"
    columns = tmp_path / "columns.toml"
    columns.write_text(
        'source = "sim:virtual-world"\n[columns]\n'
        + "".join(f'theta{leg} = "th{leg}"\n' for leg in range(1, 7))
    )
    truth = pd.read_csv(shared / "virtual-world" / "walks" / name)
    walked = predict(
        PredictRequest(
            shared / "virtual-world" / "walks" / name,
            tmp_path / "out",
            model=ModelRequest(slip="coulomb:0.38:0.001", arc_deg=200.0),
            columns=columns,
        ),
        Nobody(),
    )
    x, y = (np.interp(truth.t, walked.path.t, walked.path.position[:, i]) for i in (0, 1))
    error = np.sqrt(np.mean((x - truth.x) ** 2 + (y - truth.y) ** 2))
    assert error < 0.01 * walked.path.length
    assert summarise(walked.path).radius == pytest.approx(1.5295, rel=0.02)
    assert "simulated leg angles" in walked.title
