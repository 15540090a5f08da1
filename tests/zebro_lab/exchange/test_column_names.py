# SPDX-License-Identifier: MIT
"""Headers are split into plain names and units, and legs found in them."""

import pytest

from zebro_lab.exchange.column_guesses import UNITS
from zebro_lab.exchange.column_names import NAMES, leg_of
from zebro_lab.robot.leg_log import ANGLES


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
