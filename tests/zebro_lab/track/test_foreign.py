# SPDX-License-Identifier: MIT
"""Somebody else's path is read with its units and names, or refused by its row."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.tables.columns_file import read_section
from zebro_lab.tables.mapped_columns import canonical_columns, parse_mapped_columns
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.track.file import tum_lines
from zebro_lab.track.foreign import TRACK_UNITS, read_foreign_track, track_of_foreign_table
from zebro_lab.track.trajectory.request import Axis, TrajectoryRequest
from zebro_lab.track.trajectory.table import MAPPED_UNITS

NAMES = ("t_s", "x_m", "y_m", "yaw_rad", "z_m")
COVARIANCE = {
    "cov_xx": 4e-6, "cov_xy": 1e-6, "cov_xyaw": 0.0, "cov_yy": 9e-6, "cov_yyaw": 0.0,
    "cov_yawyaw": 1e-4,
}  # fmt: skip


def table(tmp_path, **columns) -> RawTable:
    series = {name: pd.Series(values, dtype=float) for name, values in columns.items()}
    return RawTable(tmp_path / "path.csv", series)


def track_of(read: RawTable, zero: float = 0.0):
    return track_of_foreign_table(read, canonical_columns(TRACK_UNITS)).since(zero)


def read(file: Path, **how):
    return read_foreign_track(file, canonical_columns(MAPPED_UNITS), TrajectoryRequest(**how))


def test_short_names_do_and_time_is_counted_from_the_zero_given(tmp_path):
    path = track_of(table(tmp_path, t=[5, 7, 9], x=[0, 1, 2], y=[0, 0, 1], z=[0.1] * 3), zero=4.0)
    np.testing.assert_array_equal(path.track.poses.t, [1, 3, 5])
    assert set(path.columns) == {"t_s", "x_m", "y_m", "z_m"}
    assert not path.with_covariance


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
    assert whole.with_covariance
    assert {name: whole.columns[name][1] for name in COVARIANCE} == COVARIANCE
    part = track_of(table(tmp_path, **poses, cov_xx=[4e-6] * 3))
    assert not part.with_covariance


def test_a_missing_place_is_named(tmp_path):
    with pytest.raises(DataError, match="x_m of the track"):
        track_of(table(tmp_path, t_s=[0, 1, 2], y_m=[0, 0, 0]))


@pytest.mark.parametrize("option", [{"forward": Axis.Z}, {"times": Path("times.txt")}])
def test_an_option_without_effect_on_a_plane_table_is_refused(option, tmp_path):
    file = tmp_path / "path.csv"
    file.write_text("t,x,y,yaw\n0,0,0,0\n1,1,0,0\n2,2,0,0\n")
    assert len(read(file).track.poses) == 3
    with pytest.raises(SettingsError, match=f"--{next(iter(option))}: .*leave the option out"):
        read(file, **option)


def test_a_tum_file_comes_back_as_it_was_written(tmp_path):
    poses = track_of(
        table(tmp_path, t=[0, 1, 2], x=[0, 1, 2], y=[0, 0, 1], yaw=[3.0, 3.3, 3.6])
    ).track.poses
    file = tmp_path / "path.tum"
    file.write_text("# t x y z qx qy qz qw\n" + tum_lines(poses))
    again = read(file)
    np.testing.assert_allclose(again.track.poses.position, poses.position)
    np.testing.assert_allclose(np.diff(again.track.poses.yaw), [0.3, 0.3], atol=1e-8)
    assert len(again.tum) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no pose"),
        ("0 0 0 0 0 0 0 1\n1 1 0\n", r"row 2 .line 2.*found 3 numbers"),
        ("# a\n0 0 0 0 0 0 0 2\n", r"row 1 .line 2.*length 2"),
        ("0 0 0 0 0 0 zero 1\n", "line of words; expected lines of 8"),
    ],
)
def test_a_faulty_tum_file_is_named_by_its_line(tmp_path, text, message):
    file = tmp_path / "path.tum"
    file.write_text(text)
    with pytest.raises(DataError, match=message):
        read(file)
