# SPDX-License-Identifier: MIT
"""`validate` uses what the errors of a track's poses have in common, from the file beside it."""

import shutil

import numpy as np
import pandas as pd
import pytest

from model.joint_covariance import JointCovariance
from support.validated_walks import request_of, rows_of
from support.watchers import Nobody
from zebro_lab.track.joint_file import JOINT, write_joint
from zebro_lab.validation.stage import validate

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
