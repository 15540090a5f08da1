# SPDX-License-Identifier: MIT
"""Prediction with a band and its validation, on walks simulated with other numbers."""

import numpy as np
import pandas as pd
import pytest

from support.validated_walks import request_of, rows_of
from support.watchers import Nobody
from zebro_lab.files.errors import AlreadyExists
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
