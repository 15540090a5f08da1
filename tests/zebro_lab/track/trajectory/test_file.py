# SPDX-License-Identifier: MIT
"""Trajectories as other programs write them are read right, or refused in one line."""

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from support.foreign_trajectories import HEADER, drive, euroc, kitti, tum, written
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.tables.columns_file import read_mapped_columns
from zebro_lab.track.trajectory.file import read_trajectory
from zebro_lab.track.trajectory.request import Axis, Layout, Plane, TrajectoryRequest
from zebro_lab.track.trajectory.table import MAPPED_UNITS

UNIX = 1_400_000_000.0
T, POSITION, ROTATION = drive()
FLAT = Rotation.from_euler("Z", (0.05 + 0.1 * T)[:, None])


def read(file, **options):
    return read_trajectory(file, TrajectoryRequest(**options))


def same(trajectory, t=T):
    np.testing.assert_allclose(trajectory.path.t, t, atol=5e-7)
    np.testing.assert_allclose(trajectory.path.position, POSITION, atol=1e-9)
    np.testing.assert_allclose(trajectory.path.rotation, ROTATION.as_matrix(), atol=1e-9)
    return trajectory


@pytest.mark.parametrize(
    ("name", "separator"), [("a.txt", " "), ("a.tum", "\t"), ("a.csv", "  "), ("a", " ")]
)
def test_tum_is_known_by_its_content_whatever_the_name(tmp_path, name, separator):
    file = written(tmp_path / name, "# a comment\n\n" + tum(T, POSITION, ROTATION, separator))
    assert same(read(file)).layout is Layout.TUM


def test_commas_are_read_where_the_header_names_the_quaternion(tmp_path):
    text = tum(T, POSITION, ROTATION, ",")
    names = "# timestamp,tx,ty,tz,qx,qy,qz,qw\n"
    same(read(written(tmp_path / "a.csv", names + text)))
    same(read(written(tmp_path / "b.csv", names[2:] + text)))  # a table
    same(read(written(tmp_path / "c.csv", text), layout=(Layout.TUM,)))
    in_mm = tum(T, 1000 * POSITION, ROTATION, ",")
    units = "# t [s], x [mm], y [mm], z [mm], qx, qy, qz, qw\n"
    same(read(written(tmp_path / "d.csv", units + in_mm)))


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
def test_unix_stamps_say_their_unit(tmp_path, unit):
    stamps = (UNIX + T) / {"s": 1, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[unit]
    trajectory = same(read(written(tmp_path / "a.txt", tum(stamps, POSITION, ROTATION))), UNIX + T)
    assert any("since 1970" in note for note in trajectory.notes) == (unit != "s")


@pytest.mark.parametrize("t", [T, UNIX + T])
@pytest.mark.parametrize("header", [HEADER, HEADER.replace(" [ns]", "").replace(",", ", ")])
def test_euroc_has_w_first_and_nanoseconds(tmp_path, t, header):
    trajectory = same(read(written(tmp_path / "data.csv", euroc(t, POSITION, ROTATION, header))), t)
    assert trajectory.layout is Layout.EUROC


def test_euroc_with_speeds_and_biases_is_read(tmp_path):
    lines = euroc(T, POSITION, ROTATION).splitlines()
    more = ["," + ",".join(f"v{i} [m s^-1]" for i in range(9)), *[",0" * 9] * (len(lines) - 1)]
    whole = [*map("".join, zip(lines, more, strict=True))]
    same(read(written(tmp_path / "data.csv", "\n".join(whole))))
    bare = written(tmp_path / "bare.csv", "\n".join(whole[1:]))
    same(read(bare, layout=(Layout.EUROC,)))


def test_a_quaternion_with_w_first_is_not_read_as_one_with_w_last(tmp_path):
    swapped = np.column_stack([T, POSITION, np.roll(FLAT.as_quat(), 1, axis=1)])
    file = tmp_path / "a.txt"
    np.savetxt(file, swapped)
    with pytest.raises(DataError, match=r"upright if their first number is w.*--layout euroc"):
        read(file)
    trajectory = read(file, layout=(Layout.EUROC,))
    np.testing.assert_allclose(trajectory.poses.yaw, 0.05 + 0.1 * T, atol=1e-9)
    np.testing.assert_allclose(trajectory.path.t, T)


def test_kitti_has_no_times_but_those_of_another_file(tmp_path):
    file = written(tmp_path / "00.txt", kitti(POSITION, ROTATION))
    trajectory = same(read(file), np.arange(len(T)))
    assert (trajectory.layout, trajectory.timed) == (Layout.KITTI, False)
    assert (trajectory.plane, trajectory.forward) == (Plane.XZ, Axis.Z)
    times = tmp_path / "times.txt"
    np.savetxt(times, T)
    assert same(read(file, times=times)).timed
    np.savetxt(times, T[:-1])
    with pytest.raises(SettingsError, match=r"59 times, .* has 60 poses"):
        read(file, times=times)
    np.savetxt(times, T[::-1], fmt="%.1f")
    with pytest.raises(DataError, match=r"times.txt, .*row 2 .*time goes from 5.9 to 5.8 s"):
        read(file, times=times)


def test_a_path_across_the_plane_is_noted(tmp_path):
    file = written(tmp_path / "00.txt", kitti(POSITION, ROTATION))
    assert any("across the plane xz" in note for note in read(file).notes)
    assert not any("across" in note for note in read(file, plane=Plane.XY).notes)


def test_a_table_is_read_by_its_headers(tmp_path):
    names = ["time", "pos_x", "pos_y", "pos_z", "q_x", "q_y", "q_z", "q_w"]
    frame = pd.DataFrame(np.column_stack([T, POSITION, ROTATION.as_quat()]), columns=names)
    for name, write in (("a.txt", frame.to_csv), ("a.parquet", frame.to_parquet)):
        write(tmp_path / name, index=False)
        assert same(read(tmp_path / name)).layout is Layout.TABLE


def test_a_path_too_fast_for_metres_is_asked_about_unless_they_are_stated(tmp_path):
    rows = "".join(f"{t},{150 * t},0\n" for t in range(30))
    with pytest.raises(DataError, match=r"'x': .*150 m/s, .*columns.x_m\] unit = \"mm"):
        read(written(tmp_path / "a.csv", "t,x,y\n" + rows))
    for stated in ("t_s,x_m,y_m\n", "t,x [m],y [m]\n"):
        assert read(written(tmp_path / "a.csv", stated + rows)).poses.position[-1, 0] == 4350
    milli = read(written(tmp_path / "a.csv", "t,x [mm],y [mm]\n" + rows))
    assert milli.poses.position[-1, 0] == pytest.approx(4.35)


def test_a_flat_table_has_no_place_in_space(tmp_path):
    file = written(tmp_path / "a.csv", "t,x,y,yaw\n0,0,0,0\n1,1,0,0.1\n2,2,0.1,0.2\n")
    trajectory = read(file)
    assert not trajectory.in_space
    np.testing.assert_allclose(trajectory.poses.yaw, [0, 0.1, 0.2], atol=1e-12)
    with pytest.raises(SettingsError, match=r"--plane: .*no column z"):
        read(file, plane=Plane.XZ)


@pytest.mark.parametrize("how", [{"forward": Axis.Z}, {"forward": Axis.Y}, {"plane": Plane.ZX}])
def test_a_heading_of_its_own_is_about_z_and_ahead(tmp_path, how):
    rows = "0,0,0,0,0\n1,1,0,0,0.1\n2,2,0.1,0,0.2\n"
    file = written(tmp_path / "a.csv", "t,x,y,z,yaw\n" + rows)
    with pytest.raises(SettingsError, match=f"--{next(iter(how))}: .*leave the option out"):
        read(file, **how)


LINES = tum(UNIX + T, POSITION, ROTATION).splitlines()


def test_of_a_repeated_stamp_the_first_pose_is_read_and_the_others_counted(tmp_path):
    other = LINES[-1].split()
    other[2] = f"{float(other[2]) + 1e-8:.17g}"
    text = "\n".join([*LINES, LINES[-1], " ".join(other)])
    note = same(read(written(tmp_path / "a.txt", text)), UNIX + T).notes[0]
    assert "2 rows left out" in note
    assert "1 with another pose, row 62 first" in note


@pytest.mark.parametrize(
    ("text", "how", "message"),
    [
        (tum(np.floor(UNIX + T), POSITION, ROTATION), {}, r"row 2 .line 2.*54 rows.*digits"),
        ("\n".join(["# c", *LINES[:5], LINES[6], LINES[5], *LINES[7:]]), {},
         r"row 7 .line 8.*time goes from 1400000001 to 1400000000 s.*make a file of each"),
        (tum(1e9 * T, POSITION, ROTATION), {}, r"row 1 .*1e\+08 s apart, if they are in s"),
        (tum(np.arange(60), POSITION, FLAT), {"layout": (Layout.EUROC,)}, "1e-09 s apart.* in ns"),
        ("# t [mm], x, y, z, qx, qy, qz, qw\n" + tum(T, POSITION, ROTATION, ","), {},
         "'t_s'.*'mm' cannot be converted to s.*state unit"),
        ("# t, x [s], y, z, qx, qy, qz, qw\n" + tum(T, POSITION, ROTATION, ","), {},
         "'x_m'.*'s' cannot be converted to m.*state unit"),
    ],
)  # fmt: skip
def test_what_cannot_be_times_or_lengths_is_refused_with_row_and_unit(tmp_path, text, how, message):
    with pytest.raises(DataError, match=message):
        read(written(tmp_path / "a.txt", text), **how)


def test_rows_are_chosen_from_tables_alone(tmp_path):
    (tmp_path / "columns.toml").write_text('[track.rows]\nkeep = ["x < 5"]\n')
    file = written(tmp_path / "a.tum", tum(T, POSITION, ROTATION))
    mapping, _ = read_mapped_columns("track", file, None, MAPPED_UNITS)
    same(read_trajectory(file, TrajectoryRequest(), mapping=mapping))
