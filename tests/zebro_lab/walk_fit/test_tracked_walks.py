# SPDX-License-Identifier: MIT
"""Walks that are to inform a fit: what is read, and every way in which one cannot."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.bayes.walks.prior import WalkPrior
from model.errors import ModelError
from model.gait import tripod_angles, tripod_reference
from model.gait.quantised import QuantisedLog
from support.watchers import Nobody
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.exchange.import_stage import import_run
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.walk_fit.prediction import fit_walks_on_file
from zebro_lab.walk_fit.request import WalksRequest
from zebro_lab.walk_fit.stage import calibrate_walks
from zebro_lab.walk_fit.tracked_walks import read_walk_on_file, read_walks

WALK = Path(__file__).parents[3] / "datasets" / "walk-sim"
STEP = np.radians(3.6)
SD = 0.002


def write_walk(folder, *, begin=5.0, late=0.0, covariance=True, yaw=True, robot=None, every=2.0):
    """Write a walk with a counted leg log from `begin` on and a track `late` by its clock."""
    gait = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
    t = np.arange(0.0, 12.0, 0.01)
    counted = STEP * np.round(gait.angles(t) / STEP)
    (folder / "track").mkdir(parents=True)
    pd.DataFrame({"t": t + begin} | {f"theta{i + 1}": a for i, a in enumerate(counted.T)}).to_csv(
        folder / "legs.csv", index=False
    )
    seen = np.arange(0.0, 12.0, every)
    table = pd.DataFrame({"t_s": seen + begin + late, "x_m": 0.08 * seen, "y_m": 0.0})
    if yaw:
        table["yaw_rad"] = 0.0
    if covariance:
        for name in ("xx", "yy", "yawyaw"):
            table[f"cov_{name}"] = SD**2
        for name in ("xy", "xyaw", "yyaw"):
            table[f"cov_{name}"] = 0.0
    table.to_csv(folder / "track" / "track.csv", index=False)
    if robot is not None:
        (folder / "robot.toml").write_text(robot)
    return folder


def test_a_walk_comes_with_its_time_from_zero_and_its_counts_recognised(tmp_path):
    walk = read_walk_on_file(write_walk(tmp_path / "walk"))
    assert isinstance(walk.legs, QuantisedLog)
    assert np.degrees(walk.legs.step) == pytest.approx(3.6)
    assert walk.legs.t[0] == 0
    assert walk.tracked.t[0] == pytest.approx(0.0)
    assert walk.tracked.states.shape == (6, 3)
    assert walk.files[0].name == "legs.csv"


def test_poses_outside_the_log_are_left_out_and_said(tmp_path):
    walk = read_walk_on_file(write_walk(tmp_path / "walk", late=-3.0))
    assert len(walk.tracked.t) == 4
    assert any("2 tracked poses lie outside" in note for note in walk.notes)


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"late": 1000.0}, "do both keep the same clock"),
        ({"covariance": False}, "no covariance"),
        ({"yaw": False}, "no headings"),
        ({"every": 6.0}, "has 2 poses"),
    ],
)
def test_a_track_that_says_nothing_is_refused(tmp_path, options, problem):
    with pytest.raises(DataError, match=problem):
        read_walk_on_file(write_walk(tmp_path / "walk", **options))


def test_a_leg_log_with_a_hole_of_three_seconds_is_refused(tmp_path):
    folder = write_walk(tmp_path / "walk")
    table = pd.read_csv(folder / "legs.csv")
    table[(table.t < 8.0) | (table.t > 11.0)].to_csv(folder / "legs.csv", index=False)
    with pytest.raises(DataError, match="time jumps"):
        read_walk_on_file(folder)
    table.loc[300:600, "theta3"] = np.nan
    table.to_csv(folder / "legs.csv", index=False)
    with pytest.raises(DataError, match="theta3"):
        read_walk_on_file(folder)


def test_what_is_missing_is_named(tmp_path):
    with pytest.raises(NotFound, match="no such folder"):
        read_walk_on_file(tmp_path / "none")
    folder = write_walk(tmp_path / "walk")
    (folder / "track" / "track.csv").unlink()
    with pytest.raises(NotFound, match="no track; zebro-lab track"):
        read_walk_on_file(folder)
    (folder / "legs.csv").unlink()
    with pytest.raises(NotFound, match="no leg angles"):
        read_walk_on_file(folder)


def test_walks_of_two_robots_are_not_fitted_together(tmp_path):
    one = write_walk(tmp_path / "one")
    other = write_walk(tmp_path / "other", robot="[legs]\narc_deg = 200.0\n")
    with pytest.raises(SettingsError, match="another robot"):
        read_walks([one, other])
    robot = tmp_path / "robot.toml"
    robot.write_text("mass = 2.0\n")
    assert {walk.robot.robot.mass for walk in read_walks([one, other], robot=robot)} == {2.0}


def imported_walk(folder):
    """Import the bundled walk, whose IMU comes along, and put a track of its truth beside it."""
    asked = ImportRequest(
        folder, legs=WALK / "legs.csv", imu=WALK / "imu.csv", robot=WALK / "robot.toml"
    )
    run = import_run(asked, Nobody()).folders[0]
    truth = pd.read_csv(WALK / "truth.csv")
    poses = truth[["t", "x", "y", "yaw"]].iloc[:: len(truth) // 6]
    table = poses.set_axis(["t_s", "x_m", "y_m", "yaw_rad"], axis=1)
    for name in ("xx", "yy", "yawyaw", "xy", "xyaw", "yyaw"):
        table[f"cov_{name}"] = SD**2 * (name in ("xx", "yy", "yawyaw"))
    (run / "track").mkdir()
    table.to_csv(run / "track" / "track.csv", index=False)
    return run, truth


def test_roll_and_pitch_of_a_run_s_imu_come_with_the_walk(tmp_path):
    run, truth = imported_walk(tmp_path)
    walk = read_walk_on_file(run)
    tilt = walk.tracked.tilt
    assert tilt is not None
    assert tilt.t[0] >= 0
    assert tilt.t[-1] <= walk.duration
    true = np.interp(tilt.t, truth["t"], truth["pitch"])
    away = tilt.angles[:, 1] - true
    assert np.degrees(away.std()) < 0.5
    assert any("IMU inform" in note for note in walk.notes)


def test_no_walks_are_refused_as_the_model_refuses_them():
    with pytest.raises(ModelError, match="no walk to fit"):
        fit_walks_on_file([], parse_slip("thesis"), prior=WalkPrior(), rng=np.random.default_rng(1))


def test_walks_of_one_name_are_told_apart(tmp_path):
    folders = [
        write_walk(tmp_path / day / "walk", every=every)
        for day, every in (("monday", 2.0), ("tuesday", 1.5))
    ]
    assert [walk.name for walk in read_walks(folders)] == ["walk-1", "walk-2"]


def test_walks_need_a_calibration(tmp_path):
    folder, none = write_walk(tmp_path / "walk"), CalibrationRequest(out=tmp_path / "none")
    with pytest.raises(NotFound, match="finished calibration"):
        calibrate_walks(WalksRequest((folder,)), none, Nobody())
    with pytest.raises(SettingsError, match="--walks"):
        calibrate_walks(WalksRequest(), none, Nobody())


def test_a_walk_under_two_names_counts_once_and_is_told(tmp_path):
    one = write_walk(tmp_path / "one")
    copy = shutil.copytree(one, tmp_path / "copy")
    (copy / "notes.txt").write_text("from the other disk")
    found = read_walks([one, copy, write_walk(tmp_path / "other", begin=7.0, every=1.5)])
    assert [walk.name for walk in found] == ["one", "other"]
    assert any("copy" in note and "once" in note for note in found[0].notes)
