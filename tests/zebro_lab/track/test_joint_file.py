# SPDX-License-Identifier: MIT
"""The joint covariance of a track comes back, and what does not belong to a table is not used."""

import numpy as np
import pandas as pd
import pytest

from model.joint_covariance import JointCovariance
from zebro_lab.files.errors import DataError
from zebro_lab.track.file import read_track
from zebro_lab.track.folder import track_folder
from zebro_lab.track.joint_file import JOINT, write_joint

T = np.array([0.0, 1.0, 2.0, 7.0]) / 3  # as the table cannot write them
COVARIANCE = ("xx", "xy", "xyaw", "yy", "yyaw", "yawyaw")


def joint():
    """Return poses whose errors are a random walk, and that share an error along x."""
    own = np.array([(k + 1) * np.diag([1e-6, 2e-6, 3e-6]) for k in range(4)])
    along = np.tile([[1.0], [0.0], [0.5]], (4, 1, 1))
    return JointCovariance(own, own[:-1], along, np.array([[4e-6]]))


@pytest.fixture
def folder(tmp_path):
    """Write a track folder of four poses with their joint covariance."""
    columns = {"t_s": T, "x_m": 0.1 * T, "y_m": 0 * T, "yaw_rad": 0 * T}
    rows, cols = np.triu_indices(3)
    for name, i, j in zip(COVARIANCE, rows, cols, strict=True):
        columns[f"cov_{name}"] = joint().marginal[:, i, j]
    with track_folder(
        tmp_path / "track", columns, tum=["0 0 0 0 0 0 0 1"], source="sim:test", settings={},
        inputs={}, report={},
    ) as draft:  # fmt: skip
        write_joint(draft, T, joint(), {"lens": slice(0, 1)})
    return tmp_path / "track"


def test_a_track_comes_back_with_its_joint_covariance(folder):
    track = read_track(folder)
    np.testing.assert_allclose(track.joint.dense, joint().dense, rtol=1e-9, atol=1e-15)
    assert track.notes == ()
    with np.load(folder / JOINT, allow_pickle=False) as stored:
        assert stored["causes"].tolist() == ["lens"]


def test_rows_that_were_deleted_leave_the_covariance_of_the_others(folder):
    table = pd.read_csv(folder / "track.csv")
    table.drop(index=1).to_csv(folder / "track.csv", index=False)
    kept = np.delete(np.arange(12), [3, 4, 5])
    expected = joint().dense[np.ix_(kept, kept)]
    np.testing.assert_allclose(read_track(folder).joint.dense, expected, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize(
    ("column", "change", "said"), [("t_s", 0.1, "other times"), ("cov_yy", 1e-6, "covariances")]
)
def test_the_covariance_of_other_poses_is_not_used_and_the_track_says_so(
    folder, column, change, said
):
    table = pd.read_csv(folder / "track.csv")
    table[column] += change
    table.to_csv(folder / "track.csv", index=False)
    track = read_track(folder)
    assert any(said in note and "independent" in note for note in track.notes)
    assert not np.any(track.joint.dense[:3, 3:])


def test_a_deleted_covariance_is_missed(folder):
    (folder / JOINT).unlink()
    track = read_track(folder)
    assert any(JOINT in note and "missing" in note for note in track.notes)
    assert not np.any(track.joint.dense[:3, 3:])


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("own", np.full((4, 3, 3), np.nan), "no numbers"),
        ("t", T[::-1], "do not increase"),
        ("following", np.zeros((1, 3, 3)), "parts of shape"),
        ("t", T[:3], "3 times of 4 poses"),
    ],
)
def test_a_damaged_covariance_is_refused_with_its_file(folder, name, value, said):
    with np.load(folder / JOINT) as stored:
        arrays = dict(stored)
    np.savez_compressed(folder / JOINT, **{**arrays, name: value})
    with pytest.raises(DataError, match=f"{JOINT}.*{said}"):
        read_track(folder)
