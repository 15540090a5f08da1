# SPDX-License-Identifier: MIT
"""Headers are split into plain names and units, and legs found in them."""

import pytest

from zebro_lab.exchange.column_guesses import UNITS
from zebro_lab.exchange.column_names import NAMES, leg_of, plain_name, split_header
from zebro_lab.robot.leg_log import ANGLES


@pytest.mark.parametrize(
    ("header", "name", "unit"),
    [
        ("FZ [N]", "fz", "N"), ("Zeit / ms", "zeit", "ms"), ("Kraft, kN", "kraft", "kN"),
        ("Weg in mm", "weg", "mm"), ("Slip (%)", "slip", "%"), ("t_ms", "t", "ms"),
        ("omega_l_rad_s", "omega_l", "rad/s"), ("position[0]", "position_0", None),
        ("F (left)", "f_left", None), ("FZ [kN] (left)", "fz_left", "kN"),
        ("[daN] FZ", "fz", "daN"), ("θ_1 [°]", "theta_1", "°"), ("__time", "__time", None),
        ("/imu/orientation/x", "imu_orientation_x", None),
    ],
)  # fmt: skip
def test_a_header_has_a_name_and_a_unit(header, name, unit):
    assert split_header(header) == (name, unit)
    assert set(plain_name(header)) <= set("abcdefghijklmnopqrstuvwxyz0123456789_%°")


@pytest.mark.parametrize(
    ("header", "leg"),
    [
        ("leg_front_left_joint", (1, True)), ("Hip rear right [deg]", (6, True)),
        ("vorne rechts", (2, True)), ("Bein mitte links", (3, True)), ("th4", (4, False)),
        ("joint_states/leg_5/position", (5, False)), ("2", (2, False)), ("fn1", None),
        ("leg_1_velocity", None),
        ("hip_FL", (1, False)), ("MR", (4, False)), ("leg HL angle", (5, False)),
        ("RF", (2, False)),
        ("RL", (5, False)), ("RR", (6, False)), ("torque_FL", None), ("HTML", None),
        ("left", None), ("front", None),
    ],
)  # fmt: skip
def test_a_header_names_a_leg_by_place_or_number(header, leg):
    assert leg_of(header) == leg


def test_every_canonical_column_has_names():
    for kind, units in UNITS.items():
        assert set(NAMES[kind]) | set(ANGLES) >= {
            name for name in units if not name.startswith(("cov_", "t_sigma"))
        }
