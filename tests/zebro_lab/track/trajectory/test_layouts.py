# SPDX-License-Identifier: MIT
"""Lines of numbers are a trajectory of a known layout, or refused by their line."""

import pytest

from support.foreign_trajectories import drive, kitti, tum, written
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.track.trajectory.file import read_trajectory
from zebro_lab.track.trajectory.request import Layout, TrajectoryRequest

T, POSITION, ROTATION = drive()


def read(file, **options):
    return read_trajectory(file, TrajectoryRequest(**options))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no pose"),
        ("# only a comment\n", "has no pose"),
        ("0 0 0 0 0 0 0 1\n1 1 0\n", r"row 2 .line 2.: found '1 1 0'; expected 8"),
        ("# a\n0 0 0 0 0 0 0 2\n", r"row 1 .line 2.: the quaternion has length 2"),
        ("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 zero 1\n", r"row 2 .line 2.: found .* zero 1'; expected 8"),
        ("0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n", r"row 2 .line 2.: found '1 nan .* finite"),
        ("0 1 2 3\n", r"4 numbers a line; expected 8 .TUM. or 12 .KITTI."),
        ("1 2 3 4 5 6 7 8 9 10 11 12\n", r"row 1 .line 1.: .*no rotation matrix"),
        ("1 0 0 0 0 1 0 0 0 0 -1 0\n", r"row 1 .line 1.: .*no rotation matrix"),
    ],
)
def test_what_is_no_trajectory_is_refused_by_its_line(tmp_path, text, message):
    with pytest.raises(DataError, match=message):
        read(written(tmp_path / "a.txt", text))


def test_a_layout_that_does_not_fit_is_refused(tmp_path):
    with pytest.raises(DataError, match=r"8 numbers a line; expected 12"):
        read(written(tmp_path / "a.txt", tum(T, POSITION, ROTATION)), layout=(Layout.KITTI,))
    with pytest.raises(DataError, match="12 numbers a line; expected 8"):
        read(written(tmp_path / "b.txt", kitti(POSITION, ROTATION)), layout=(Layout.TUM,))
    with pytest.raises(DataError, match="line of words"):
        read(written(tmp_path / "c.csv", "t,x,y\n0,0,0\n"), layout=(Layout.TUM,))
    with pytest.raises(NotFound):
        read(tmp_path / "missing.txt")
