# SPDX-License-Identifier: MIT
"""Columns are recognised by their headers, set-points by how seldom they change."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from zebro_lab.exchange.column_guesses import guess_columns, guess_kind
from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.columns import IMU, TRACK
from zebro_lab.tables.header_units import unit_in_header
from zebro_lab.tables.raw_table import RawTable


def one(*headers: str, cells=(1.0, 2.0)) -> RawTable:
    units = {name: unit for name in headers if (unit := unit_in_header(name))}
    columns = {name: pd.Series(cells) for name in headers}
    return RawTable(Path("a.csv"), columns, units=units)


@pytest.mark.parametrize(
    ("kind", "headers"),
    [
        ("rig", "ET V FX FY FZ SL"), ("rig", "Zeit Schlupf Normalkraft Zugkraft"),
        ("legs", "t theta1 theta2 theta3 theta4 theta5 theta6"),
        ("legs", "time leg_0 leg_1 leg_2 leg_3 leg_4 leg_5"),
        ("imu", "header.stamp.sec orientation.x orientation.y orientation.z orientation.w"),
        ("imu", "Time Gyro_X Gyro_Y Gyro_Z Acc_X Acc_Y Acc_Z"),
        ("imu", "Zeit Rollwinkel Nickwinkel"),
        ("track", "t x y"), ("track", "time pose.position.x pose.position.y"),
    ],
)  # fmt: skip
def test_headers_tell_the_kind_of_a_table(kind, headers):
    assert guess_kind(one(*headers.split())) == kind


@pytest.mark.parametrize("headers", ["a b", "t x y roll pitch", "t x y FZ"])
def test_a_kind_that_headers_leave_open_is_asked_for(headers):
    with pytest.raises(SettingsError, match=r"--kind: a\.csv (may be|fits no kind)"):
        guess_kind(one(*headers.split()))


@pytest.mark.parametrize(("unit", "turn"), [("deg", 360.0), ("turns", 1.0), ("rad", 2 * np.pi)])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_sign_of_a_leg_is_found_in_turns_of_its_unit(unit, turn, sign):
    angle = (sign * np.arange(200) * turn / 60) % turn  # 6 deg a row
    names = [f"theta{leg} [{unit}]" for leg in range(1, 7)]
    guesses = guess_columns(one(*names, cells=angle), "legs")
    assert {guess.sign for guess in guesses.values()} == {sign}


def test_legs_by_place_are_sure_and_numbers_of_other_programs_are_not():
    places = ["front_left", "front right", "Bein_mitte_links", "mid-right", "rear left",
              "hinten rechts"]  # fmt: skip
    guesses = guess_columns(one("t", *places), "legs")
    assert [guesses[f"theta{leg}"].name for leg in range(1, 7)] == places
    assert not any(guess.name_doubt for guess in guesses.values())
    numbered = guess_columns(one("t", *(f"position[{i}]" for i in range(6))), "legs")
    assert numbered["theta1"].name == "position[0]"
    assert {"column", "unit", "sign", "zero"} == set(numbered["theta6"].doubts)


def test_seconds_and_nanoseconds_of_a_ros_stamp_belong_together():
    guess = guess_columns(one("header.stamp.sec", "header.stamp.nanosec", "FZ"))["t"]
    assert (guess.name, guess.nanoseconds, guess.doubts) == (
        "header.stamp.sec", "header.stamp.nanosec", (),
    )  # fmt: skip


def test_ros_fields_are_in_si_and_others_are_to_check():
    ros = guess_columns(one("orientation.x", "orientation.w", "angular_velocity.z"), "imu")
    assert not any(guess.doubts for guess in ros.values())
    other = guess_columns(one("Gyro_Z", "Roll"), "imu")
    assert {guess.doubts for guess in other.values()} == {("unit", "sign")}


def test_names_that_everybody_uses_are_in_si_only_beside_our_own():
    assert guess_columns(one("t", "Fn"))["t"].doubts == ("unit",)
    assert guess_columns(one("t", "normal_force"))["t"].doubts == ()
    assert guess_columns(one("t", "roll", "pitch"), "imu")["roll"].doubts == ("unit", "sign")
    assert guess_columns(one("t", "x_m", "y_m", "yaw"), "track")["yaw_rad"].doubts == ()


@pytest.mark.parametrize(
    ("header", "canonical", "unit"),
    [
        ("FZ [N]", "normal_force", "N"), ("Fn (kN)", "normal_force", "kN"),
        ("t_ms", "t", "ms"), ("Time", "t", "s?"), ("omega_l_rpm", "omega_leg", "rpm"),
        ("Slip Ratio", "slip_ratio", "%?"), ("FX [mm]", "traction_force", "N?"),
        ("Normalkraft / kN", "normal_force", "kN"), ("Zeit in ms", "t", "ms"),
        ("Schlupf [%]", "slip_ratio", "%"), ("slip_percent", "slip_ratio", "%"),
        ("Drehzahl Bein", "omega_leg", "rpm?"), ("Drehzahl Boden [1/min]", "omega_ground", "1/min"),
        ("Längskraft (N)", "traction_force", "N"), ("ω_leg [rad/s]", "omega_leg", "rad/s"),
        ("FZ [lbs]", "normal_force", "lbf?"), ("stamp_ms", "t", "ms"),
        ("Winkelgeschw. Bein [°/s]", "omega_leg", "°/s"), ("millis", "t", "ms?"),
        ("Zugkraft_kN", "traction_force", "kN"), ("Drehzahl Fußscheibe", "omega_leg", "rpm?"),
        ("foot disc speed [rpm]", "omega_leg", "rpm"),
    ],
)  # fmt: skip
def test_a_header_gives_name_and_unit_and_what_is_not_stated_is_in_doubt(header, canonical, unit):
    (found,) = guess_columns(one(header)).items()
    said = found[1].unit.unit + "?" * bool(found[1].unit.doubt)
    assert (found[0], found[1].name, said) == (canonical, header, unit)


def test_the_canonical_name_wins_and_other_matches_and_signs_are_kept():
    columns = {
        "FZ": pd.Series([5.0]),
        "normal_force": pd.Series([-5.0]),
        "colour": pd.Series(["r"]),
    }
    (guess,) = guess_columns(RawTable(Path("a.csv"), columns)).values()
    assert (guess.name, guess.sign, guess.doubts) == ("normal_force", -1, ("sign",))
    del columns["normal_force"]
    columns["Fn"] = columns["FZ"]
    (guess,) = guess_columns(RawTable(Path("a.csv"), columns)).values()
    assert (guess.name, guess.name_doubt) == ("FZ", "could also be 'Fn'")


def test_a_quaternion_of_motion_capture_is_found_whole_or_not(tmp_path):
    names = ["Time (Seconds)", *(f"Body Position {a}" for a in "XYZ")]
    turned = [f"Body Rotation {a}" for a in "XYZW"]
    values = pd.DataFrame(np.eye(8), columns=[*names, *turned])
    for columns, found in ((turned, {"qx", "qy", "qz", "qw"}), (turned[:3], set())):
        table = RawTable(tmp_path / "take.csv", dict(values[[*names, *columns]].items()))
        guesses = guess_columns(table, TRACK)
        assert {name for name in guesses if name[0] == "q"} == found
        assert "which axis is up" in guesses["y_m"].name_doubt
        assert not any(guesses[name].doubts for name in found)


def test_columns_whose_numbers_cannot_be_read_have_their_sign_in_doubt():
    cells = {"FZ [mN]": ["4'976.7", "4'961.8"], "FX [mN]": ["439.6", "1'395.2"]}
    raw = RawTable(Path("a.csv"), {name: pd.Series(texts) for name, texts in cells.items()})
    assert [guess.doubts[-1] for guess in guess_columns(raw).values()] == ["sign", "sign"]


def test_a_header_that_several_columns_have_is_in_doubt():
    columns = {name: pd.Series([0.0, 1.0]) for name in ("t", "x", "y", "y (2)")}
    raw = RawTable(Path("a.csv"), columns, repeated=frozenset({"y"}))
    found = guess_columns(raw, TRACK)
    assert "column" in found["y_m"].doubts
    assert "several columns have this header" in found["y_m"].name_doubt
    assert "sign" in found["y_m"].doubts
    assert "column" not in found["x_m"].doubts


@pytest.mark.parametrize(("up", "unit"), [(1.02, "g?"), (9.8, "m/s^2?"), (0.3, "m/s^2?")])
def test_a_specific_force_that_averages_one_is_taken_for_multiples_of_g(up, unit):
    cells = {"t": [0.0, 1.0], "ax": [0.0, 0.1], "ay": [0.0, 0.0], "az": [up, up]}
    raw = RawTable(Path("a.csv"), {name: pd.Series(values) for name, values in cells.items()})
    found = [guess_columns(raw, IMU)[f"force_{axis}"].unit for axis in "xyz"]
    assert {each.unit + "?" * bool(each.doubt) for each in found if each} == {unit}


@pytest.mark.parametrize(
    ("headers", "expected"),
    [
        (["Wheel speed [rpm]", "Belt speed [m/s]"], ["omega_leg", "speed_ground"]),
        (["v_ball (mm/s)", "u disc (mm/s)"], ["speed_ground", "speed_leg"]),
        (["omega_leg", "omega_ground"], ["omega_leg", "omega_ground"]),
        (["F_T (N)", "mu (-)", "std F_T (N)"], ["traction_force", None, "traction_force_sd"]),
        (["COF", "COF std"], ["traction_coefficient", "traction_coefficient_sd"]),
        (["Friction (-)", "W (N)"], ["traction_coefficient", "normal_force"]),
        (["Friction (N)", "Applied load (N)"], ["traction_force", "normal_force"]),
        (["F_t/F_n", "Fn mean (N)"], ["traction_coefficient", "normal_force"]),
        (["avg_Fx", "std_Fx"], ["traction_force", "traction_force_sd"]),
    ],
)
def test_quantities_of_published_tables_are_told_by_name_and_unit(headers, expected):
    found = {guess.name: name for name, guess in guess_columns(one(*headers)).items()}
    assert [found.get(header) for header in headers] == expected
