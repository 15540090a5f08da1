# SPDX-License-Identifier: MIT
"""Prediction with a band and its validation, on walks simulated with other numbers."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

from model.gait import tetrapod_reference, tripod_angles, tripod_reference
from model.robot import Robot
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.traction import VelocityCoulomb
from support.watchers import Nobody
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound, SettingsError
from zebro_lab.main import app
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.terminal.ending import run as run_app
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.stage import validate
from zebro_lab.walk.path_band import read_draws
from zebro_lab.walk.predict_stage import predict
from zebro_lab.walk.prediction_file import read_prediction
from zebro_lab.walk.request import BandRequest, ModelRequest, PredictRequest

STEP = np.radians(3.6)
DURATION = 12.0


def gait(steering):
    return tripod_reference(tripod_angles(np.radians(50.0), steering), 2.0)


def write_walk_data(folder, *, steering=1.2, offset_deg=0.0, seed=3):
    """Write a simulated walk's counted leg log and its track; return both files."""
    reference = gait(steering)
    robot = Robot(leg_offset=np.radians(offset_deg) * np.array([0, 1, 0, 0, 0, 0]))
    table = VelocityCoulomb(0.38).table(weight=robot.mass * 9.81)
    true = planar_walk(WalkDraw(robot, reference, table), duration=DURATION).poses
    t = np.arange(0, DURATION, 0.01)
    counted = STEP * np.round(reference.angles(t) / STEP)
    legs = pd.DataFrame({"t": t} | {f"theta{i + 1}": counted[:, i] for i in range(6)})
    legs.to_csv(folder / "legs.csv", index=False)
    rng = np.random.default_rng(seed)
    seen = np.arange(0.5, DURATION - 0.1, 1.0)
    x, y, yaw = true.at(seen).states.T
    c, s = np.cos(0.7), np.sin(0.7)  # the floor's frame is not the robot's
    noise = rng.normal(0, [[0.002], [0.002], [0.005]], (3, len(seen)))
    track = pd.DataFrame({
        "t_s": seen, "x_m": 1 + c * x - s * y + noise[0], "y_m": s * x + c * y + noise[1],
        "yaw_rad": yaw + 0.7 + noise[2], "cov_xx": 4e-6, "cov_xy": 0.0, "cov_xyaw": 0.0,
        "cov_yy": 4e-6, "cov_yyaw": 0.0, "cov_yawyaw": 2.5e-5,
    })  # fmt: skip
    track.to_csv(folder / "track.csv", index=False)
    return folder / "legs.csv", folder / "track.csv"


def request_of(pairs, out, **options):
    predicted, track = zip(*pairs, strict=True)
    return ValidateRequest(predicted=predicted, track=track, out=out, **options)


def predicted(folder, legs, *, draws=60, name="prediction"):
    request = PredictRequest(
        legs,
        folder / name,
        model=ModelRequest(slip="coulomb:0.38", band=BandRequest(draws)),
    )
    predict(request, Nobody())
    return folder / name


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    """Return a folder with legs.csv, track/track.csv and prediction/."""
    folder = tmp_path_factory.mktemp("walk")
    legs, track = write_walk_data(folder)
    (folder / "track").mkdir()
    track.rename(folder / "track" / "track.csv")
    predicted(folder, legs)
    return folder


@pytest.fixture(scope="module")
def validated(walk):
    request = ValidateRequest((walk,), out=walk / "validation")
    return validate(request, Nobody())


def rows_of(validated):
    return {row.name: row for row in validated.runs[0].rows}


def test_a_prediction_from_counted_angles_is_within_two_percent_of_the_path(validated):
    errors = rows_of(validated)["prediction"].errors
    assert errors.ate_of_length < 0.02
    assert errors.radius[0] == pytest.approx(errors.radius[1], rel=0.03)


def test_the_band_beats_every_baseline(validated):
    rows = rows_of(validated)
    assert set(rows) == {"prediction", "no-slip-simple", "no-slip", "thesis", "stand still"}
    for name, row in rows.items():
        if name != "prediction":
            assert rows["prediction"].scores.energy < row.scores.energy, name


def test_a_track_of_the_same_physics_is_plausible(validated):
    assert all(each.p_value > 0.01 for each in rows_of(validated)["prediction"].consistency)


def test_the_first_tracked_pose_starts_the_prediction_and_is_not_scored(validated, walk):
    tracked = pd.read_csv(walk / "track/track.csv")
    assert len(validated.runs[0].track) == len(tracked) - 1


def test_the_folder_holds_tables_pictures_tum_files_and_a_manifest(validated, walk):
    folder = walk / "validation"
    manifest = json.loads((folder / "manifest.json").read_text())
    assert "sim:dynamics" in manifest["source"]
    assert len(manifest["inputs"]) == 3
    assert set(manifest["outputs"]) == {p.name for p in folder.iterdir()} - {"manifest.json"}
    metrics = pd.read_csv(folder / "metrics.csv").set_index("model")
    assert metrics.loc["prediction", "ate_m"] < metrics.loc["no-slip", "ate_m"]
    tum = np.loadtxt(next(folder.glob("*.track.tum")))
    assert tum.shape == (len(validated.runs[0].track), 8)


def test_draws_come_back_and_stale_ones_go(tmp_path):
    legs, _ = write_walk_data(tmp_path)
    folder = predicted(tmp_path, legs, draws=4)
    draws = read_draws(folder)
    assert draws.position.shape == (4, len(draws.t), 2)
    band = pd.read_csv(folder / "band.csv")
    assert (band["x_q050"] <= band["x_q950"]).all()
    predicted(tmp_path, legs, draws=0)
    with pytest.raises(NotFound, match="--draws"):
        read_draws(folder)


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


def test_several_walks_get_a_mean_with_an_interval(tmp_path):
    pairs = []
    for i, steering in enumerate((1.1, 1.2, 1.3)):
        folder = tmp_path / f"walk{i}"
        folder.mkdir()
        legs, track = write_walk_data(folder, steering=steering, seed=i)
        pairs.append((predicted(folder, legs, draws=0), track))
    done = validate(request_of(pairs, tmp_path / "out"), Nobody())
    assert {run.name for run in done.runs} == {"walk0", "walk1", "walk2"}
    ate = next(s for s in done.summary if (s.model, s.metric) == ("prediction", "ate_m"))
    assert ate.interval.low <= ate.interval.mean <= ate.interval.high


def test_clocks_apart_are_refused_and_an_offset_brings_them_together(walk, tmp_path):
    prediction, track = pairs_of_run(walk)
    late = pd.read_csv(track / "track.csv")
    late["t_s"] += 1000
    late.to_csv(tmp_path / "late.csv", index=False)
    pair = ((prediction, tmp_path / "late.csv"),)
    with pytest.raises(DataError, match="--time-offset"):
        validate(request_of(pair, tmp_path / "out"), Nobody())
    assert not (tmp_path / "out").exists()
    done = validate(request_of(pair, tmp_path / "out", time_offset=-1000.0), Nobody())
    assert rows_of(done)["prediction"].errors.ate_of_length < 0.02


def test_another_command_s_folder_is_not_renewed(walk):
    prediction, _ = pairs_of_run(walk)
    with pytest.raises(AlreadyExists, match="another command"):
        validate(ValidateRequest((walk,), out=prediction), Nobody())


def test_a_run_without_a_track_says_what_to_do(walk, tmp_path):
    with pytest.raises(NotFound, match="predict"):
        pairs_of_run(tmp_path)
    (tmp_path / "prediction").symlink_to(walk / "prediction")
    with pytest.raises(NotFound, match=r"track\.csv"):
        pairs_of_run(tmp_path)


def test_a_band_needs_the_model_that_has_one(tmp_path):
    legs, _ = write_walk_data(tmp_path)
    request = PredictRequest(
        legs, tmp_path / "out", model=ModelRequest(model="no-slip", band=BandRequest(10))
    )
    with pytest.raises(SettingsError, match="dynamics"):
        predict(request, Nobody())
    with pytest.raises(SettingsError, match="no band"):
        BandRequest(1)


def test_the_command_prints_a_table_and_says_simulated(walk, tmp_path, monkeypatch, capsys):
    prediction, track = pairs_of_run(walk)
    arguments = ["--predicted", prediction, "--track", track, "--out", tmp_path / "out"]
    monkeypatch.setattr("sys.argv", ["zebro-lab", "validate", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        run_app(app)
    printed = capsys.readouterr().out
    assert not ended.value.code
    assert "SIMULATED" in printed
    assert "no-slip-simple" in printed
    assert "coverage of the 90% band: x " in printed
    assert "predicted uncertainty (NEES)" in printed


@pytest.mark.reference
def test_a_stranger_s_wheeled_robot_goes_through_unbent(shared, tmp_path):
    """Two wheels without slip: the aligned error its data's keeper measured, 62 mm."""
    folder = shared / "realdata/wheel-odometry"
    rows = [line.split() for line in (folder / "Indoor_UWB_Input.txt").read_text().splitlines()]
    odometry = np.array([row[1:4] for row in rows if row[0] == "odom2diff"], dtype=float)
    t, left, right = odometry.T
    rate, speed = (right - left) / 0.157, 0.5 * (left + right)
    steps = np.diff(t, prepend=t[0])
    yaw = np.cumsum(rate * steps)
    middle = yaw - 0.5 * rate * steps
    x, y = np.cumsum(speed * steps * np.cos(middle)), np.cumsum(speed * steps * np.sin(middle))
    pd.DataFrame({"t": t, "x": x, "y": y, "yaw": yaw}).to_csv(tmp_path / "wheels.csv", index=False)
    rows = [line.split() for line in (folder / "Indoor_UWB_GT.txt").read_text().splitlines()]
    truth = np.array([row[1:4] for row in rows if row[0] == "point2"], dtype=float)
    pd.DataFrame(truth, columns=["t", "x", "y"]).to_csv(tmp_path / "truth.csv", index=False)
    pair = ((tmp_path / "wheels.csv", tmp_path / "truth.csv"),)
    done = validate(request_of(pair, tmp_path / "out", anchor=False), Nobody())
    errors = rows_of(done)["prediction"].errors
    assert 0.05 < errors.ate_aligned < 0.07
    assert errors.ate > errors.ate_aligned


def test_the_log_of_the_bundled_walk_is_counted():
    from pathlib import Path

    from model.gait.quantised import find_step

    log = read_leg_log(Path(__file__).parents[3] / "datasets/walk-sim/legs.csv")
    assert np.degrees(find_step(log.reference.theta)) == pytest.approx(3.6, rel=1e-3)


def standing_walk(folder, *, behind):
    """Write a path that stands, turns a circle and stands, and its track by a clock behind it."""
    t = np.arange(0.0, 24.0, 0.05)
    gone = 0.1 * np.clip(t - 2.0, 0.0, 20.0)
    path = pd.DataFrame(
        {"t": t, "x": 1.5 * np.sin(gone / 1.5), "y": 1.5 - 1.5 * np.cos(gone / 1.5)}
    )
    path["yaw"] = gone / 1.5
    path.to_csv(folder / "path.csv", index=False)
    track = path.iloc[6::40].copy()
    noise = np.random.default_rng(1).normal(0, 0.002, (len(track), 3))
    track[["x", "y", "yaw"]] += noise
    track["t"] -= behind
    track.to_csv(folder / "seen.csv", index=False)
    return folder / "path.csv", folder / "seen.csv"


def test_another_clock_s_offset_is_found_and_told(tmp_path):
    pair = standing_walk(tmp_path, behind=1234.5)
    done = validate(request_of((pair,), tmp_path / "out", estimate_offset=True), Nobody())
    assert rows_of(done)["prediction"].errors.ate < 0.01
    assert any(note.startswith("clock: +1234.") and "±" in note for note in done.runs[0].notes)
    settings = json.loads((tmp_path / "out/manifest.json").read_text())["settings"]
    assert settings["time_offset_estimated"]
    assert settings["time_offset"]["path"] == pytest.approx(1234.5, abs=0.1)


def test_an_offset_that_the_motion_does_not_tell_is_asked_for(walk, tmp_path):
    prediction, track = pairs_of_run(walk)  # an even walk: neither starts nor stops in view
    request = request_of(((prediction, track),), tmp_path / "out", estimate_offset=True)
    with pytest.raises(DataError, match="--time-offset"):
        validate(request, Nobody())
    assert not (tmp_path / "out").exists()


def test_a_track_of_two_poses_is_refused(walk, tmp_path):
    prediction, track = pairs_of_run(walk)
    pd.read_csv(track / "track.csv").iloc[:2].to_csv(tmp_path / "two.csv", index=False)
    pair = ((prediction, tmp_path / "two.csv"),)
    with pytest.raises(DataError, match="has 2 poses; expected 3 or more"):
        validate(request_of(pair, tmp_path / "out"), Nobody())


def test_a_run_under_two_names_is_averaged_once_and_told(walk, tmp_path):
    copy = shutil.copytree(walk, tmp_path / "copy")
    done = validate(ValidateRequest((walk, copy), out=tmp_path / "out"), Nobody())
    assert len(done.runs) == 1
    assert not done.summary
    assert any("copy" in note and "once" in note for note in done.runs[0].notes)
