# SPDX-License-Identifier: MIT
"""From a gait or a leg log to a finished walk folder."""

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


def test_pictures_come_when_asked_for_and_say_simulated(tmp_path):
    watcher = Nobody()
    walk(request(tmp_path / "out", pictures=PictureRequest(figures=True)), watcher)
    names = {f"{name}.png" for name in (*PICTURES, "stances")}
    assert {p.name for p in (tmp_path / "out").iterdir()} == names | {"path.csv", "manifest.json"}
    assert [what for what, _ in watcher.seen] == ["walking", "drawing"]


def test_film_comes_when_asked_for(tmp_path):
    watcher = Nobody()
    walk(
        replace(request(tmp_path / "out", pictures=PictureRequest(animate=True)), duration=0.2),
        watcher,
    )
    assert len(list((tmp_path / "out").glob("animation.*"))) == 1
    assert watcher.seen[-1] == ("filming", 1.0)


def test_stopped_walk_leaves_nothing_behind(tmp_path):
    with pytest.raises(WalkStopped, match="nothing was written"):
        walk(request(tmp_path / "out", pictures=PictureRequest(figures=True)), Impatient())
    assert list(tmp_path.iterdir()) == []


def test_model_that_slips_needs_a_law_and_one_that_does_not_says_so(tmp_path):
    with pytest.raises(SettingsError, match="--slip: missing"):
        walk(request(tmp_path / "out", slip=None), Nobody())
    walked = walk(request(tmp_path / "out", model="no-slip"), Nobody())
    assert "--slip coulomb:0.4 is not used" in walked.notes[0]


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


def test_predict_takes_what_walk_wrote(run_command, tmp_path):
    walk = tmp_path / "walk"
    asked = ("walk", "--slip", "coulomb:0.4", "--duration", 3, "--out", walk)
    assert run_command(*asked).code == 0
    ended = run_command("predict", walk, "--model", "no-slip", "--out", tmp_path / "predicted")
    assert ended.code == 0
    assert "logged leg angles, model 'no-slip'" in ended.out
    assert "straight ahead" in ended.out


def test_leg_log_with_a_gap_is_one_line_with_its_place(run_command, tmp_path):
    log = tmp_path / "legs.csv"
    rows = [f"{t / 100},{','.join([str(t / 50)] * 6)}" for t in (*range(30), *range(60, 90))]
    log.write_text("\n".join(["t,theta1,theta2,theta3,theta4,theta5,theta6", *rows]) + "\n")
    ended = run_command("predict", log, "--slip", "thesis", "--out", tmp_path / "out")
    assert ended.code == 1
    assert ended.err.startswith(f"error: {log}, column 't', row 31 (line 32): time jumps from 0.29")


def test_options_reach_the_prediction_and_its_folder(run_command, tmp_path):
    log = write_log(tmp_path)
    (tmp_path / "robot.toml").write_text("mass = 3.0\n[legs]\narc_deg = 200\n")
    out = tmp_path / "out"
    ended = run_command("predict", log, "--model", "no-slip-simple", "--dt", "0.02", "--robot",
                        tmp_path / "robot.toml", "--direction", "right",
                        "--out", out)  # fmt: skip
    assert (ended.code, ended.err) == (0, "")
    assert "SIMULATED walk: " in ended.out
    assert str(out / "path.csv") in ended.out
    settings = read_walk_manifest(out)["settings"]
    assert (settings["model"], settings["dt"], settings["direction"]) == (
        "no-slip-simple", 0.02, "right",
    )  # fmt: skip
    assert settings["robot"]["mass"] == 3.0
    assert settings["robot"]["leg_arc"] == pytest.approx(np.radians(200))


def test_a_band_without_a_model_of_slip_and_a_missing_law_are_named(run_command, tmp_path):
    log = write_log(tmp_path)
    given = ("predict", log, "--out", tmp_path / "out")
    ended = run_command(*given, "--model", "no-slip-simple", "--draws", 5)
    assert ended.code == 2
    assert "--draws: a band is predicted by the model 'dynamics' only" in ended.err
    assert run_command(*given).code == 2
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("address", "problem"),
    [("here", "expected tcp://HOST:PORT"), ("tcp://8.8.8.8:8786", "outside of this machine")],
)
@pytest.mark.parametrize("name", ["predict none.csv", "walk --duration 2"])
def test_a_scheduler_that_cannot_be_used_is_told_before_anything_is_read(
    run_command, tmp_path, name, address, problem
):
    out = tmp_path / "out"
    ended = run_command(
        *name.split(), "--slip", "none.toml", "--draws", 2, "--out", out, "--scheduler", address
    )
    assert ended.code == 2
    assert "--scheduler" in ended.err
    assert problem in ended.err
    assert not out.exists()


GAIT = ("--steering", 1.0, "--slip", "coulomb:0.38", "--dt", 0.004)
GROUND = """
slope_deg = [4, 0]
heights = { file = "h.csv", step = 0.05, origin = [-0.5, -1] }
"""
SMALL_MAP = """
heights = "h.csv"
step = 0.1
origin = [-0.2, -0.2]
"""
PROGRAM = """
[[segment]]
gait = "tripod"
until = { near = [0.2, 0, 0.05] }
"""


@pytest.fixture
def ground(tmp_path):
    """Return a function that writes a ground.toml."""

    def write(text):
        file = tmp_path / "ground.toml"
        file.write_text(text)
        return file

    return write


def test_a_walk_up_a_slope_and_a_step_says_so(run_command, ground, tmp_path):
    file, out = ground(GROUND), tmp_path / "out"
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
    raised = path.position[-1, 2] - path.position[0, 2]
    assert raised == pytest.approx(climbed, abs=0.012)
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
    code, text, error = run_command(
        "walk", *GAIT, "--duration", 4, "--ground", ground(SMALL_MAP), "--out", tmp_path / "out"
    )
    assert code == 0, error
    assert "WARNING: the robot is off the map of heights in" in text
    hip = Robot().hips[:, 0].max()
    path = read_walk(tmp_path / "out")
    left = path.t[(path.position[:, 0] + hip > 0.2).argmax()]
    assert f"first {left:.2f} s after the start" in text.replace("\n", " ")


def test_a_program_finds_its_places_on_the_ground(run_command, ground, tmp_path):
    program = tmp_path / "program.toml"
    program.write_text(PROGRAM)
    uphill = ground("slope_deg = [8, 0]\n")
    code, text, error = run_command(
        "walk", program, "--slip", "coulomb:0.38", "--ground", uphill, "--out", tmp_path / "out"
    )
    assert code == 0, error
    assert "slope of 8 deg" in text
    assert read_walk(tmp_path / "out").position[-1, 0] == pytest.approx(0.2, abs=0.05)


@pytest.mark.parametrize("model", ["thesis", "no-slip", "no-slip-simple"])
def test_models_of_level_ground_refuse_another(run_command, ground, tmp_path, model):
    code, _, error = run_command(
        "walk", "--slip", "thesis", "--model", model, "--duration", 1,
        "--ground", ground("slope_deg = [1, 0]"), "--out", tmp_path / "out",
    )  # fmt: skip
    assert code in (1, 2)
    assert f"the model '{model}' walks on level ground only" in error
    assert not (tmp_path / "out").exists()


def test_the_ground_itself_is_not_written_over(run_command, ground, tmp_path):
    file = ground("slope_deg = [1, 0]")
    code, _, _ = run_command("walk", *GAIT, "--duration", 1, "--ground", file, "--out", file)
    assert code != 0
    assert file.read_text() == "slope_deg = [1, 0]"
