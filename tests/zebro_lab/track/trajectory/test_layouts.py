# SPDX-License-Identifier: MIT
"""Lines of numbers are a trajectory of a known layout, or refused by their line."""

import pytest

from support.foreign_trajectories import drive, kitti, tum, written
from zebro_lab.files.errors import DataError
from zebro_lab.track.trajectory.file import read_trajectory
from zebro_lab.track.trajectory.request import Layout, TrajectoryRequest

T, POSITION, ROTATION = drive()


def read(file, **options):
    return read_trajectory(file, TrajectoryRequest(**options))


@pytest.mark.parametrize(
    ("text", "how", "message"),
    [
        ("# only a comment\n", {}, "is empty or all comments"),
        ("0 0 0 0 0 0 0 1\n1 1 0\n", {}, r"row 2 .line 2.: the row has 3 cells, .* 8"),
        ("# a\n0 0 0 0 0 0 0 2\n", {}, r"row 1 .line 2.: the quaternion has length 2"),
        ("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 zero 1\n", {}, r"row 2 .line 2.: 'zero' is not a number"),
        ("0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n", {}, r"'x_m', row 2 .line 2.: is empty; .*leave"),
        ("0 1 2 3\n", {}, r"4 numbers a line; .*8 .TUM. .*12 .KITTI."),
        (tum(*drive(), ","), {}, r"8 numbers .*--layout tum"),
        ("0," * 16 + "1\n", {}, r"17 numbers .*--layout tum"),
        ("1 2 3 4 5 6 7 8 9 10 11 12\n", {}, r"row 1 .line 1.: .*no rotation matrix"),
        ("1 0 0 0 0 1 0 0 0 0 -1 0\n", {}, r"row 1 .line 1.: .*no rotation matrix"),
        (tum(T, POSITION, ROTATION), {"layout": (Layout.KITTI,)}, "8 numbers a line; expected 12"),
        (kitti(POSITION, ROTATION), {"layout": (Layout.TUM,)}, "12 numbers a line; expected 8"),
        ("t,x,y\n0,0,0\n", {"layout": (Layout.TUM,)}, "3 numbers a line; expected 8"),
    ],
)
def test_what_is_no_trajectory_is_refused_by_its_line(tmp_path, text, how, message):
    with pytest.raises(DataError, match=message):
        read(written(tmp_path / "a.txt", text), **how)
