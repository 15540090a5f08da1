# SPDX-License-Identifier: MIT
"""Prediction with a band and its validation, on walks simulated with other numbers."""

import shutil

import numpy as np
import pandas as pd
import pytest

from model.joint_covariance import JointCovariance
from support.validated_walks import request_of, rows_of
from support.watchers import Nobody
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.track.joint_file import JOINT, write_joint
from zebro_lab.validation.predicted_walks import pairs_of_run
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.stage import validate


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


def test_another_command_s_folder_is_not_renewed(walk):
    prediction, _ = pairs_of_run(walk)
    with pytest.raises(AlreadyExists, match="another command"):
        validate(ValidateRequest((walk,), out=prediction), Nobody())


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


def test_evo_a_peer_finds_the_same_errors_in_the_tum_files(tmp_path):
    """Of a circle against a wider one, seen with noise: both are planar, so alignment agrees."""
    pytest.importorskip("evo", reason="evo is an extra: pip install evo")
    from evo.core.metrics import APE, RPE, PoseRelation, StatisticsType, Unit
    from evo.core.sync import associate_trajectories
    from evo.tools.file_interface import read_tum_trajectory_file

    t = np.linspace(0.0, 30.0, 601)
    for name, radius, keep in (("path", 1.9, slice(None)), ("track", 2.0, slice(0, None, 20))):
        yaw = 0.1 * t / 2.0
        xy = radius * np.column_stack([np.sin(yaw), 1 - np.cos(yaw)])
        noise = np.random.default_rng(1).normal(0, 0.003, (len(t), 3)) * (name == "track")
        table = pd.DataFrame(np.column_stack([xy, yaw]) + noise, columns=["x", "y", "yaw"])
        table.insert(0, "t", t)
        table.iloc[keep].to_csv(tmp_path / f"{name}.csv", index=False)
    pair = ((tmp_path / "path.csv", tmp_path / "track.csv"),)
    done = validate(request_of(pair, tmp_path / "out"), Nobody())
    errors = rows_of(done)["prediction"].errors
    files = [next((tmp_path / "out").glob(f"*.{which}.tum")) for which in ("track", "predicted")]
    both = associate_trajectories(*(read_tum_trajectory_file(str(file)) for file in files))

    def rmse(metric):
        metric.process_data(both)
        return metric.get_statistic(StatisticsType.rmse)

    assert rmse(APE(PoseRelation.translation_part)) == pytest.approx(errors.ate, rel=1e-4)
    assert rmse(APE(PoseRelation.rotation_angle_rad)) == pytest.approx(errors.yaw, rel=1e-3)
    # evo counts poses where we count metres: a step of the track is 0.1 m
    step = next(each for each in errors.relative if each.distance == 0.5).position
    assert rmse(RPE(PoseRelation.translation_part, 5, Unit.frames)) == pytest.approx(step, rel=0.15)
    both[1].align(both[0])
    aligned = rmse(APE(PoseRelation.translation_part))
    assert aligned == pytest.approx(errors.ate_aligned, rel=1e-3)


SCALE_SD = 0.03


@pytest.fixture
def enlarged(walk, tmp_path):
    """Return a track that is 3 % too large, as far as its standard deviations, and its joint file.

    A wrong height of the marker does that: all poses lie too far out alike.
    """
    folder = tmp_path / "track"
    shutil.copytree(walk / "track", folder)
    table = pd.read_csv(folder / "track.csv")
    poses = table[["x_m", "y_m", "yaw_rad"]].to_numpy()
    out = np.zeros((len(poses), 3, 1))
    out[:, :2, 0] = poses[:, :2] - poses[0, :2]
    table[["x_m", "y_m"]] += SCALE_SD * out[:, :2, 0]
    own = np.array([np.diag(row) for row in table[["cov_xx", "cov_yy", "cov_yawyaw"]].to_numpy()])
    joint = JointCovariance(own, 0 * own[1:], out, np.array([[SCALE_SD**2]]))
    for name, i, j in (("xx", 0, 0), ("xy", 0, 1), ("yy", 1, 1), ("yawyaw", 2, 2)):
        table[f"cov_{name}"] = joint.marginal[:, i, j]
    table.to_csv(folder / "track.csv", index=False)
    write_joint(folder, table["t_s"].to_numpy(), joint, {"height": slice(0, 1)})
    return folder


def test_poses_that_err_alike_widen_the_interval_of_the_mean_error_along(walk, enlarged, tmp_path):
    found = {}
    for name in ("with", "without"):
        if name == "without":
            (enlarged / JOINT).unlink()
        done = validate(request_of(((walk / "prediction", enlarged),), tmp_path / name), Nobody())
        judged = rows_of(done)["prediction"].consistency
        found[name] = next(each for each in judged if each.name == "along")
    widths = {name: each.high - each.low for name, each in found.items()}
    assert widths["with"] > 2 * widths["without"]
    assert found["with"].p_value > 0.2
