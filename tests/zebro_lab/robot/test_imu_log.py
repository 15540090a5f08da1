# SPDX-License-Identifier: MIT
"""Orientation comes from quaternions or from angles, the same by both."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from zebro_lab.files.errors import DataError
from zebro_lab.robot.imu_log import IMU_UNITS, ImuLog, imu_of_table
from zebro_lab.tables.columns import Columns
from zebro_lab.tables.raw_table import RawTable

T = [0.0, 0.1]


def read(**columns) -> ImuLog:
    series = {name: pd.Series(values) for name, values in ({"t": T} | columns).items()}
    return imu_of_table(RawTable(Path("imu.csv"), series), Columns(IMU_UNITS))


def in_radians(**columns) -> ImuLog:
    """Read angles whose unit the file states: any attitude."""
    series = {name: pd.Series(values) for name, values in ({"t": T} | columns).items()}
    raw = RawTable(Path("imu.csv"), series, units={"roll": "rad"})
    return imu_of_table(raw, Columns(IMU_UNITS))


def orientation(log: ImuLog) -> np.ndarray:
    return vars(log)["values"][:, :4]


@given(roll=st.floats(-3, 3), pitch=st.floats(-1.5, 1.5), yaw=st.floats(-3, 3))
def test_angles_and_their_quaternion_are_the_same_orientation(roll, pitch, yaw):
    by_angles = in_radians(roll=[0.0, roll], pitch=[0.0, pitch], yaw=[0.0, yaw])
    quaternion = dict(zip(("qw", "qx", "qy", "qz"), orientation(by_angles).T, strict=True))
    np.testing.assert_array_equal(orientation(read(**quaternion)), orientation(by_angles))
    found = Rotation.from_quat(orientation(by_angles)[1], scalar_first=True).as_matrix()
    expected = (Rotation.from_rotvec([0, 0, yaw]) * Rotation.from_rotvec([0, pitch, 0])
                * Rotation.from_rotvec([roll, 0, 0])).as_matrix()  # fmt: skip
    np.testing.assert_allclose(found, expected, atol=1e-12)
    assert by_angles.notes == ()


@pytest.mark.parametrize("tilt", ["roll", "pitch"])
def test_a_body_that_tilts_far_without_a_stated_unit_is_asked_about(tilt):
    level = {"roll": [0.0, 0.0], "pitch": [0.0, 0.0]}
    with pytest.raises(
        DataError, match=r"up to 2 rad, 115 deg, .*\[columns\.roll\] unit = \"deg\""
    ):
        read(**{**level, tilt: [0.0, -2.0]})
    assert in_radians(**{**level, tilt: [0.0, -2.0]}).t.tolist() == T
    read(**{**level, tilt: [0.0, 0.9]}, yaw=[0.0, 9.0])


def test_a_specific_force_in_g_is_refused_unless_its_unit_is_stated():
    level = {"roll": [0.0, 0.0], "pitch": [0.0, 0.0], "force_x": [0.0, 0.1], "force_y": [0.0, 0.0]}
    with pytest.raises(DataError, match=r"force is 1.02 m/s\^2 in the middle.*unit = \"g\""):
        read(**level, force_z=[1.02, 1.01])
    assert read(**level, force_z=[9.8, 9.9]).notes == read(roll=[0.0, 0.0], pitch=[0.0, 0.0]).notes
    stated = Columns(IMU_UNITS)
    for axis in "xyz":
        stated = stated.called(f"force_{axis}", f"a{axis}_g")
    table = {"t": T, "az_g": [1, 1]} | {key: [0, 0] for key in ("roll", "pitch", "ax_g", "ay_g")}
    raw = RawTable(Path("imu.csv"), {name: pd.Series(cells) for name, cells in table.items()})
    log = imu_of_table(raw, stated)
    assert vars(log)["values"][:, 9].tolist() == [9.80665, 9.80665]
    assert "'az_g' in g times 9.80665" in log.notes[0]


def test_what_is_not_measured_is_nan_and_a_missing_yaw_is_noted():
    log = read(roll=[0.0, 0.0], pitch=[0.0, 0.0], rate_y=[1.0, 2.0], force_z=[9.8, 9.9])
    np.testing.assert_array_equal(orientation(log), [[1, 0, 0, 0]] * 2)
    np.testing.assert_array_equal(
        vars(log)["values"][:, 4:], [[np.nan, 1.0, np.nan, np.nan, np.nan, 9.8],
                            [np.nan, 2.0, np.nan, np.nan, np.nan, 9.9]],
    )  # fmt: skip
    np.testing.assert_array_equal(log.t, T)
    assert log.notes == ("imu.csv has no column of yaw; yaw is not measured",)
    assert not log.has_yaw


def test_columns_that_no_quantity_is_read_from_are_named():
    log = read(roll=[0.0, 0.0], pitch=[0.0, 0.0], yaw=[0.0, 0.0], gyro_yaw=[1.0, 2.0])
    assert "not read: 'gyro_yaw'" in log.notes[0]
    assert log.has_yaw


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"qw": [1.0, 0.9], "qx": [0.0, 0.0], "qy": [0.0, 0.0], "qz": [0.0, 0.0]},
         "column 'qw', row 2: the quaternion has length 0.9; expected 1 within 0.05"),
        ({"qw": [1.0, 1.0], "qx": [0.0, 0.0], "qy": [0.0, 0.0]}, "the column of the qz of the"),
        ({"roll": [0.0, 0.0]}, "'pitch': the column of the pitch of the body is missing"),
        ({"heading": [0.0, 0.0]}, "orientation, roll and pitch or a quaternion qw, qx, qy, qz, is"),
        ({"t": [0.1, 0.1], "roll": [0.0, 0.0], "pitch": [0.0, 0.0]}, "expected increasing times"),
    ],
)  # fmt: skip
def test_what_is_no_orientation_is_named(columns, message):
    with pytest.raises(DataError, match=message):
        read(**columns)
