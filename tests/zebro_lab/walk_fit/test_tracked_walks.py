# SPDX-License-Identifier: MIT
"""Walks that are to inform a fit: what is read, and every way in which one cannot."""

import shutil

import numpy as np
import pandas as pd
import pytest

from model.gait.inexact_log import InexactLog
from support.tracked_walks import SD, WALK, write_walk
from support.watchers import Nobody
from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.exchange.import_stage import import_run
from zebro_lab.files.errors import DataError, NotFound, SettingsError
from zebro_lab.runs.exclusion import exclude_run
from zebro_lab.walk_fit.tracked_walks import read_walk_on_file, read_walks


def test_a_walk_comes_with_its_time_from_zero_and_its_counts_recognised(tmp_path):
    walk = read_walk_on_file(write_walk(tmp_path / "walk"))
    assert isinstance(walk.legs, InexactLog)
    assert np.degrees(walk.legs.step) == pytest.approx(3.6)
    assert walk.legs.t[0] == 0
    assert walk.tracked.t[0] == pytest.approx(0.0)
    assert walk.tracked.states.shape == (6, 3)
    assert walk.files[0].name == "legs.csv"


def test_poses_outside_the_log_are_left_out_and_said(tmp_path):
    walk = read_walk_on_file(write_walk(tmp_path / "walk", late=-3.0))
    assert len(walk.tracked.t) == 4
    assert any("2 poses outside the leg log" in note for note in walk.notes)


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"late": 1000.0}, "do both keep the same clock"),
        ({"covariance": False}, "no covariance.*: import the track with --track-sd '1 mm' --track"),
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


def imported_walk(folder):
    """Import the bundled walk, whose IMU comes along, and put a track of its truth beside it."""
    asked = ImportRequest(
        folder, legs=WALK / "legs.csv", imu=WALK / "imu.csv", robot=WALK / "robot.toml"
    )
    run = import_run(asked, Nobody()).folder
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


def test_of_two_imus_the_one_that_informs_is_named(tmp_path):
    run, _ = imported_walk(tmp_path)
    shutil.copy(run / "profiles" / "imu.toml", run / "profiles" / "imu2.toml")
    notes = read_walk_on_file(run).notes
    assert "roll and pitch are those of imu; not used: imu2" in notes


def test_walks_of_one_name_are_told_apart(tmp_path):
    folders = [
        write_walk(tmp_path / day / "walk", every=every)
        for day, every in (("monday", 2.0), ("tuesday", 1.5))
    ]
    assert [walk.name for walk in read_walks(folders)] == ["walk-1", "walk-2"]


def test_a_walk_under_two_names_counts_once_and_is_told(tmp_path):
    one = write_walk(tmp_path / "one")
    copy = shutil.copytree(one, tmp_path / "copy")
    (copy / "notes.txt").write_text("from the other disk")
    found = read_walks([one, copy, write_walk(tmp_path / "other", begin=7.0, every=1.5)])
    assert [walk.name for walk in found] == ["one", "other"]
    assert any("copy" in note and "duplicate" in note for note in found[0].notes)


def test_an_excluded_run_is_left_out_and_told(tmp_path):
    run, _ = imported_walk(tmp_path)
    exclude_run(run, why="a leg was loose")
    found = read_walks([run, run, write_walk(tmp_path / "other")])
    assert [walk.name for walk in found] == ["other"]
    assert f"left out, {run}: excluded, a leg was loose" in found[0].notes
    with pytest.raises(DataError, match=r"no walk to fit: .* a leg was loose"):
        read_walks([run])
