# SPDX-License-Identifier: MIT
"""From a gait, a program or a leg log to a finished walk folder, on level and on other ground."""

import hashlib
import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from model.errors import DomainError
from model.robot import Robot
from model.walk_models import MODELS
from support.walk_requests import request, write_log
from support.watchers import Impatient, Nobody
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.folder import PICTURES, read_draws, read_walk, read_walk_manifest
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.request import BandRequest, ModelRequest, PictureRequest, PredictRequest
from zebro_lab.walk.stage import predict, walk
from zebro_lab.walk.summary import summarise

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_a_gait_has_a_band_around_its_path(tmp_path):
    asked = request(tmp_path / "out", dt=0.005, band=BandRequest(12, offset_sd_deg=1.0))
    walked = walk(asked, Nobody())
    draws = read_draws(tmp_path / "out")
    assert draws.position.shape[0] == 12
    end, spread = draws.position[:, -1], draws.position[:, -1].std(axis=0)
    assert np.all(np.abs(end.mean(axis=0) - walked.path.position[-1, :2]) < 3 * spread)
    assert np.all(spread > 1e-4)
    assert read_walk_manifest(tmp_path / "out")["settings"]["band"]["draws"] == 12


def test_a_band_needs_the_model_that_has_one_and_else_nothing_is_left(tmp_path):
    with pytest.raises(SettingsError, match="dynamics"):
        walk(request(tmp_path / "out", model="no-slip", band=BandRequest(12)), Nobody())
    model = ModelRequest(model="no-slip", band=BandRequest(10))
    with pytest.raises(SettingsError, match="dynamics"):
        predict(PredictRequest(write_log(tmp_path), tmp_path / "out", model=model), Nobody())
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


def test_pictures_and_a_film_come_when_asked_for(tmp_path):
    watcher = Nobody()
    asked = request(tmp_path / "out", pictures=PictureRequest(figures=True, animate=True))
    walk(replace(asked, duration=0.2), watcher)
    names = {p.name for p in (tmp_path / "out").iterdir() if p.stem != "animation"}
    drawn = {f"{name}.png" for name in (*PICTURES, "stances")}
    assert names == drawn | {"path.csv", "manifest.json"}
    assert len(list((tmp_path / "out").glob("animation.*"))) == 1
    assert [what for what, _ in watcher.seen][:3] == ["walking", "drawing", "filming"]


def test_a_stopped_walk_leaves_nothing_behind(tmp_path):
    with pytest.raises(WalkStopped):
        walk(request(tmp_path / "out", pictures=PictureRequest(figures=True)), Impatient())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("bad", [{"dt": 0.0}, {"dt": -1.0}, {"dt": float("nan")}, {"dt": 100.0}])
def test_a_step_longer_than_the_walk_is_refused(bad, tmp_path):
    with pytest.raises((SettingsError, DomainError)):
        walk(request(tmp_path / "out", **bad), Nobody())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("model", MODELS)
def test_a_walk_of_more_steps_than_memory_holds_is_refused(model, tmp_path):
    for asked in (
        replace(request(tmp_path / "out", model=model), duration=1e12),
        request(tmp_path / "out", model=model, dt=2e-6),
    ):
        with pytest.raises(SettingsError, match=r"--duration, --dt: .*500,000"):
            walk(asked, Nobody())


COULOMB = ModelRequest(slip="coulomb:0.4")


@pytest.mark.parametrize("model", MODELS)
def test_a_right_turn_mirrors_the_left_one_in_its_log(model, tmp_path):
    rates = []
    for side in ("left", "right"):
        log, options = write_log(tmp_path, direction=side), replace(COULOMB, model=model)
        asked = PredictRequest(log, tmp_path / side, direction=side, model=options)
        rates.append(summarise(predict(asked, Nobody()).path).yaw_rate)
    assert [np.sign(rate) for rate in rates] == [1, -1]


def test_predicting_a_gaits_own_log_walks_the_gait(tmp_path):
    walked = walk(request(tmp_path / "walk"), Nobody()).path
    log = write_log(tmp_path, start=100.0)
    predicted = predict(PredictRequest(log, tmp_path / "p", model=COULOMB), Nobody()).path
    np.testing.assert_allclose(predicted.t - 100, walked.t, atol=1e-9)
    # the log has straight lines across the instants at which legs change speed
    np.testing.assert_allclose(predicted.position, walked.position, atol=1e-3)


@pytest.mark.parametrize("name", ["walk", "walk/path.csv"])
def test_a_walked_path_leads_where_it_led_though_legs_are_offset(name, tmp_path):
    robot = tmp_path / "robot.toml"
    robot.write_text("[legs]\noffset_deg = [0, 0, -5, 0, 0, 0]\nsign = [-1, 1, 1, 1, 1, 1]\n")
    walked = walk(request(tmp_path / "walk", robot=robot), Nobody()).path
    asked = PredictRequest(tmp_path / name, tmp_path / "p", model=replace(COULOMB, robot=robot))
    again = predict(asked, Nobody()).path
    np.testing.assert_allclose(again.theta, walked.theta, atol=1e-9)
    np.testing.assert_allclose(again.position, walked.position, atol=1e-6)


def test_a_robot_file_changes_the_robot_and_the_reading_of_the_log(tmp_path):
    robot = tmp_path / "robot.toml"
    robot.write_text("mass = 3.0\n[legs]\nsign = [-1, -1, -1, -1, -1, -1]\n")
    asked = PredictRequest(write_log(tmp_path), tmp_path / "a", model=COULOMB)
    plain = predict(asked, Nobody()).path
    log, model = write_log(tmp_path, sign=-1), replace(COULOMB, robot=robot)
    signed = predict(PredictRequest(log, tmp_path / "b", model=model), Nobody()).path
    np.testing.assert_allclose(signed.position, plain.position, atol=2e-3)
    load = signed.normal_force[250].sum() / plain.normal_force[250].sum()
    assert load == pytest.approx(3.0 / 2.17, rel=0.01)
    manifest = read_walk_manifest(tmp_path / "b")
    assert manifest["settings"]["robot"]["mass"] == 3.0
    assert set(manifest["inputs"]) == {str(log), str(robot)}


@pytest.mark.reference
def test_log_of_the_virtual_world_leads_where_its_robot_went(shared, tmp_path):
    log = shared / "virtual-world/walks/tripod_s1.30_left_mu0.38_tc2_arc200real.csv.gz"
    columns, robot = tmp_path / "columns.toml", tmp_path / "robot.toml"
    names = "".join(f'theta{leg} = "th{leg}"\n' for leg in range(1, 7))
    columns.write_text(f'source = "sim:virtual-world"\n[columns]\n{names}')
    robot.write_text("[legs]\narc_deg = 200\n")
    model = ModelRequest(slip="coulomb:0.38:0.001", robot=robot)
    asked = PredictRequest(log, tmp_path / "out", model=model, columns=columns)
    walked, truth = predict(asked, Nobody()), pd.read_csv(log)
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


GAIT = ("--steering", 1.0, "--slip", "coulomb:0.38", "--dt", 0.004)


@pytest.fixture
def ground(tmp_path):
    """Return a function that writes a ground.toml."""

    def write(text):
        file = tmp_path / "ground.toml"
        file.write_text(text)
        return file

    return write


def test_a_walk_up_a_slope_and_a_step_says_so(run_command, ground, tmp_path):
    file, out = ground('slope_deg = [4, 0]\nheights = { file = "h.csv", step = 0.05, '
                       'origin = [-0.5, -1] }\n'), tmp_path / "out"  # fmt: skip
    step = np.where(np.arange(61) > 12, 0.005, 0.0)  # 5 mm higher from x = 0.15 m on
    np.savetxt(tmp_path / "h.csv", np.tile(step, (41, 1)), delimiter=",")
    code, text, error = run_command("walk", *GAIT, "--duration", 5, "--ground", file, "--out", out)
    assert code == 0, error
    for part in ("on ground.toml", "slope of 4 deg along x", "heights of h.csv"):
        assert part in text
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["inputs"][str(file)] == hashlib.sha256(file.read_bytes()).hexdigest()
    assert manifest["settings"]["ground"]["slope_deg"] == [4.0, 0.0]
    path = read_walk(out)
    climbed = np.tan(np.radians(4)) * path.position[-1, 0] + 0.005
    assert path.position[-1, 2] - path.position[0, 2] == pytest.approx(climbed, abs=0.012)
    code, predicted, error = run_command(
        "predict", out, "--slip", "coulomb:0.38", "--dt", 0.004, "--ground", file, "--draws", 3,
        "--out", tmp_path / "again",
    )  # fmt: skip
    assert code == 0, error
    assert "heights of h.csv" in predicted
    again = read_walk(tmp_path / "again")
    np.testing.assert_allclose(again.position[-1], path.position[-1], atol=0.01)
    draws = read_draws(tmp_path / "again")
    assert np.abs(draws.position[:, -1] - path.position[-1, :2]).max() < 0.1


def test_a_robot_that_walks_off_its_map_is_told_when(run_command, ground, tmp_path):
    (tmp_path / "h.csv").write_text("0,0,0,0,0\n" * 5)
    small = ground('heights = "h.csv"\nstep = 0.1\norigin = [-0.2, -0.2]\n')
    code, text, error = run_command(
        "walk", *GAIT, "--duration", 4, "--ground", small, "--out", tmp_path / "out"
    )
    assert code == 0, error
    assert "WARNING: the robot is off the map of heights" in text
    path = read_walk(tmp_path / "out")
    left = path.t[(path.position[:, 0] + Robot().hips[:, 0].max() > 0.2).argmax()]
    assert f"first {left:.2f} s after the start" in text.replace("\n", " ")


def test_a_program_finds_its_places_on_the_ground(run_command, ground, tmp_path):
    program, out = tmp_path / "program.toml", tmp_path / "out"
    program.write_text('[[segment]]\ngait = "tripod"\nuntil = { near = [0.2, 0, 0.05] }\n')
    uphill = ground("slope_deg = [8, 0]\n")
    code, text, error = run_command(
        "walk", program, "--slip", "coulomb:0.38", "--ground", uphill, "--out", out
    )
    assert code == 0, error
    assert "slope of 8 deg" in text
    assert read_walk(out).position[-1, 0] == pytest.approx(0.2, abs=0.05)


def test_the_ground_itself_is_not_written_over(run_command, ground):
    file = ground("slope_deg = [1, 0]")
    code, _, _ = run_command("walk", *GAIT, "--duration", 1, "--ground", file, "--out", file)
    assert code != 0
    assert file.read_text() == "slope_deg = [1, 0]"
