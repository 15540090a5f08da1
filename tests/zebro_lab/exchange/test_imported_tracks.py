# SPDX-License-Identifier: MIT
"""Paths of other programs become tracks of runs, alone or with leg angles."""

import numpy as np
import pandas as pd
import pytest

from support.foreign_trajectories import drive, kitti, written
from support.imported_files import T, taken
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.track.file import read_track
from zebro_lab.track.trajectory.request import Plane, TrajectoryRequest


def test_a_trajectory_alone_makes_a_run_with_a_track(tmp_path):
    t, position, rotation = drive()
    file = written(tmp_path / "a.txt", kitti(position, rotation))
    times = written(tmp_path / "times.txt", "".join(f"{stamp:.17g}\n" for stamp in t))
    how = TrajectoryRequest(plane=Plane.XY, times=times)
    folder = taken(tmp_path, track=file, trajectory=how).folder
    poses = read_track(folder / "track").poses
    np.testing.assert_allclose(poses.t, t, atol=1e-9)
    np.testing.assert_allclose(poses.position, position[:, :2], atol=1e-9)
    ahead = rotation.apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(np.tan(poses.yaw), ahead[:, 1] / ahead[:, 0], atol=1e-6)
    assert read_manifest(folder).sources == {"track": "import:a.txt"}


MOCAP = """
[track.columns]
t_s = "Time (Seconds)"
""" + "".join(
    f'{axis}_m = {{name = "Body Position {axis.upper()}", unit = "mm"}}\n' for axis in "xyz"
) + "".join(f'q{axis} = "Body Rotation {axis.upper()}"\n' for axis in "xyzw")  # fmt: skip


def test_mapped_quaternions_of_a_motion_capture_table_are_the_heading(tmp_path):
    t, position, rotation = drive()
    columns = {"Frame": np.arange(len(t)), "Time (Seconds)": t}
    columns |= {f"Body Rotation {a}": q for a, q in zip("XYZW", rotation.as_quat().T, strict=True)}
    columns |= {f"Body Position {a}": 1e3 * p for a, p in zip("XYZ", position.T, strict=True)}
    pd.DataFrame(columns).to_csv(tmp_path / "take.csv", index=False)
    written(tmp_path / "columns.toml", MOCAP)
    poses = read_track(taken(tmp_path, track=tmp_path / "take.csv").folder / "track").poses
    np.testing.assert_allclose(poses.position, position[:, :2], atol=1e-9)
    ahead = rotation.apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(np.tan(poses.yaw), ahead[:, 1] / ahead[:, 0], atol=1e-6)


def test_a_track_of_another_clock_is_brought_to_that_of_the_legs(files, tmp_path):
    table = pd.read_csv(files / "track.csv")
    table.assign(t=table.t - 1000.25).to_csv(files / "track.csv", index=False)
    both = {"legs": files / "legs.csv", "track": files / "track.csv"}
    with pytest.raises(DataError, match=r"shared; add --track-offset 1000\.25 where both"):
        taken(tmp_path, **both)
    folder = taken(tmp_path, **both, track_offset=1000.25).folder
    np.testing.assert_allclose(read_track(folder / "track").poses.t, T[::20], atol=1e-9)


@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        ({"plane": Plane.XY}, DataError, "has no times.*--times"),
        ({"times": "times.txt"}, SettingsError, "^--plane: .*across the plane xz.*state the plane"),
    ],
)
def test_what_a_trajectory_leaves_open_is_asked_for(tmp_path, how, error, message):
    t, position, rotation = drive()
    file = written(tmp_path / "a.txt", kitti(position, rotation))
    written(tmp_path / "times.txt", "".join(f"{stamp}\n" for stamp in t))
    how = {key: tmp_path / v if key == "times" else v for key, v in how.items()}
    with pytest.raises(error, match=message):
        taken(tmp_path, track=file, trajectory=TrajectoryRequest(**how))
    assert not (tmp_path / "data").exists()
