# SPDX-License-Identifier: MIT
"""Somebody else's path is read with its units and names, or refused by its row."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.columns_file import parse_mapped_columns, read_mapped_columns
from zebro_lab.tables.columns_sections import read_section
from zebro_lab.track.file import tum_lines
from zebro_lab.track.foreign import read_foreign_track
from zebro_lab.track.trajectory.request import TrajectoryRequest
from zebro_lab.track.trajectory.table import MAPPED_UNITS

COVARIANCE = {
    "cov_xx": 4e-6, "cov_xy": 1e-6, "cov_xyaw": 0.0, "cov_yy": 9e-6, "cov_yyaw": 0.0,
    "cov_yawyaw": 1e-4,
}  # fmt: skip


def table(tmp_path, **columns) -> Path:
    pd.DataFrame(columns).to_csv(tmp_path / "path.csv", index=False)
    return tmp_path / "path.csv"


def track_of(file: Path, zero: float = 0.0):
    return read(file).since(zero)


def read(file: Path, **how):
    return read_foreign_track(file, Columns(MAPPED_UNITS), TrajectoryRequest(**how))


def test_short_names_do_and_time_is_counted_from_the_zero_given(tmp_path):
    path = track_of(table(tmp_path, t=[5, 7, 9], x=[0, 1, 2], y=[0, 0, 1], z=[0.1] * 3), zero=4.0)
    np.testing.assert_array_equal(path.track.poses.t, [1, 3, 5])
    assert set(path.columns) == {"t_s", "x_m", "y_m", "z_m"}


def test_headings_in_degrees_without_a_unit_are_asked_about(tmp_path):
    angle = np.linspace(0, 1.5, 20)
    file = tmp_path / "path.csv"
    frame = {"t_s": angle, "x_m": np.sin(angle), "y_m": 1 - np.cos(angle)}
    pd.DataFrame(frame | {"yaw_rad": np.degrees(angle)}).to_csv(file, index=False)
    with pytest.raises(DataError, match=r"path.csv, column 'yaw_rad': .*85.94 rad .* unit = \"deg"):
        read(file)
    pd.DataFrame(frame | {"yaw [deg]": np.degrees(angle)}).to_csv(file, index=False)
    np.testing.assert_allclose(read(file).track.poses.yaw, angle, atol=1e-9)
    (tmp_path / "columns.toml").write_text('[track.columns.yaw_rad]\nunit = "rad"\n')
    pd.DataFrame(frame | {"yaw_rad": np.degrees(angle)}).to_csv(file, index=False)
    stated = parse_mapped_columns(read_section("track", tmp_path / "columns.toml"), MAPPED_UNITS)
    track = read_foreign_track(file, stated, TrajectoryRequest())
    np.testing.assert_allclose(np.sin(track.track.poses.yaw), np.sin(np.degrees(angle)))


def test_a_covariance_comes_back_where_all_of_it_is_there(tmp_path):
    poses = {"t_s": [0, 1, 2], "x_m": [0, 1, 2], "y_m": [0, 0, 0], "yaw_rad": [0, 0, 0]}
    whole = track_of(table(tmp_path, **poses, **{k: [v] * 3 for k, v in COVARIANCE.items()}))
    assert {name: whole.columns[name][1] for name in COVARIANCE} == COVARIANCE
    part = track_of(table(tmp_path, **poses, cov_xx=[4e-6] * 3))
    assert "cov_xx" not in part.columns


def test_standard_deviations_give_a_covariance_in_any_plane(tmp_path):
    poses = {"t_s": [0, 1, 2], "x_m": [0, 1, 2], "y_m": [0, 0, 0], "z_m": [0, 0, 1]}
    asked = TrajectoryRequest(plane="xz")
    track = read_foreign_track(
        table(tmp_path, **poses), Columns(MAPPED_UNITS), asked, sd=(0.01, None)
    )
    np.testing.assert_allclose(track.columns["cov_xx"], 1e-4)


def test_times_beside_a_file_that_has_some_are_refused(tmp_path):
    file = table(tmp_path, t=[0, 1, 2], x=[0, 1, 2], y=[0, 0, 0])
    with pytest.raises(SettingsError, match=r"--times: .*leave the option out"):
        read(file, times=Path("times.txt"))


def test_a_tum_file_comes_back_as_it_was_written(tmp_path):
    poses = track_of(
        table(tmp_path, t=[0, 1, 2], x=[0, 1, 2], y=[0, 0, 1], yaw=[3.0, 3.3, 3.6])
    ).track.poses
    file = tmp_path / "path.tum"
    file.write_text("# t x y z qx qy qz qw\n" + tum_lines(poses))
    again = read(file)
    np.testing.assert_allclose(again.track.poses.position, poses.position)
    np.testing.assert_allclose(np.diff(again.track.poses.yaw), [0.3, 0.3], atol=1e-8)


def mocap(tmp_path, **columns) -> Path:
    """Write the table of a motion-capture system that lost the body in rows 3, 4 and 7."""
    n = np.arange(9.0)
    frame = pd.DataFrame({"Frame": n, "t": 0.1 * n, "x": 0.02 * n, "y": 0 * n, "yaw": 0 * n})
    frame = frame.assign(**columns)
    frame.loc[[2, 3, 6], ["x", "y", "yaw"]] = np.nan
    frame.to_csv(tmp_path / "mocap.csv", index=False)
    return tmp_path / "mocap.csv"


def test_poses_without_any_number_are_gaps_and_counted_and_rows_keep_their_numbers(tmp_path):
    t = [0, 0.1, 0.2, 0.3, 0.4, 0.2, 0.6, 0.7, 0.8]
    with pytest.raises(DataError, match=r"row 6 \(line 7\): time goes from 0\.4 to 0\.2"):
        read(mocap(tmp_path, t=t))
    path = read(mocap(tmp_path))
    np.testing.assert_allclose(path.track.poses.t, [0, 0.1, 0.4, 0.5, 0.7, 0.8])
    assert "mocap.csv: 3 empty poses left out, the first in row 3" in path.track.notes


def test_a_pose_that_is_partly_empty_is_refused_and_left_out_as_the_message_says(tmp_path):
    file = mocap(tmp_path)
    frame = pd.read_csv(file)
    frame.loc[4, "x"] = np.nan
    frame.to_csv(file, index=False)
    with pytest.raises(DataError, match=r"row 5 \(line 6\): is empty") as raised:
        read(file)
    advice = 'keep = ["`x` > -1e9"]'
    assert advice in str(raised.value)
    (tmp_path / "columns.toml").write_text(f"[track.rows]\n{advice}\n")
    stated = read_mapped_columns("track", file, None, MAPPED_UNITS)[0]
    path = read_foreign_track(file, stated, TrajectoryRequest())
    np.testing.assert_allclose(path.track.poses.t, [0, 0.1, 0.5, 0.7, 0.8])
