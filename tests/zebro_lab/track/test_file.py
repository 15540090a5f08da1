# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.track.file import read_track

COVARIANCE = "cov_xx,cov_xy,cov_xyaw,cov_yy,cov_yyaw,cov_yawyaw"


def write(tmp_path, text):
    file = tmp_path / "track.csv"
    file.write_text(text)
    return file


def test_a_track_with_covariance_comes_back(tmp_path):
    rows = "\n".join(f"{t},{0.1 * t},0,0.1,4e-6,1e-6,0,9e-6,0,1e-4" for t in (0, 2, 5))
    write(tmp_path, f"t_s,x_m,y_m,yaw_rad,{COVARIANCE}\n{rows}\n")
    track = read_track(tmp_path)
    np.testing.assert_array_equal(track.poses.t, [0, 2, 5])
    np.testing.assert_allclose(track.covariance[1, 0], [4e-6, 1e-6, 0])
    np.testing.assert_allclose(track.covariance, np.swapaxes(track.covariance, 1, 2))
    assert track.notes == ()


def test_a_stranger_s_track_without_headings_is_read_and_says_so(tmp_path):
    track = read_track(write(tmp_path, "t,x,y\n0,0,0\n1,1,0\n2,2,0\n"))
    assert not track.poses.has_yaw
    assert not track.covariance.any()
    assert "no column yaw_rad" in " ".join(track.notes)


def test_units_that_the_table_states_are_used(tmp_path):
    file = tmp_path / "track.csv"
    file.write_text("t,x,y,yaw\nms,mm,cm,deg\n0,10,1,0\n500,20,2,90\n1000,30,3,180\n")
    poses = read_track(file).poses
    np.testing.assert_allclose(poses.t, [0, 0.5, 1])
    np.testing.assert_allclose(poses.position, [[0.01, 0.01], [0.02, 0.02], [0.03, 0.03]])
    np.testing.assert_allclose(poses.yaw, [0, np.pi / 2, np.pi])
    file.write_text("t,x,y\ns,N,m\n0,10,1\n500,20,2\n1000,30,3\n")
    with pytest.raises(DataError, match="column 'x': the file states its unit: unit 'N'"):
        read_track(file)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,x\n0,0\n1,0\n2,0\n", "y_m or y"),
        ("t,x,y\n0,0,0\n1,0,0\n", "has 2 poses"),
        ("t,x,y\n0,0,0\n", "has 1 pose; expected"),
        ("t,x,y\n0,0,0\n2,0,0\n1,0,0\n", "increasing"),
        ("t,x,y\n0,0,0\n1,,0\n2,0,0\n", "is empty; expected a finite number"),
    ],
)
def test_what_is_no_track_is_refused_with_its_place(tmp_path, text, message):
    with pytest.raises(DataError, match=message) as error:
        read_track(write(tmp_path, text))
    assert "track.csv" in str(error.value)


def test_an_impossible_covariance_is_refused(tmp_path):
    rows = "\n".join(f"{t},0,0,0,-1,0,0,1,0,1" for t in range(3))
    with pytest.raises(DataError, match="negative eigenvalue"):
        read_track(write(tmp_path, f"t,x,y,yaw,{COVARIANCE}\n{rows}\n"))


def test_a_missing_track_is_named(tmp_path):
    with pytest.raises(NotFound, match=r"track\.csv"):
        read_track(tmp_path)
