# SPDX-License-Identifier: MIT
"""A joint's leg is taken from its name alone, and only where the name states it."""

import pytest

from zebro_lab.robot.joint_names import legs_of_joints

SIDES = ("left", "right")
NAMES = {
    "numbers": [f"leg_{leg}" for leg in range(1, 7)],
    "numbers within": [f"base_leg{leg}_joint" for leg in range(1, 7)],
    "words": [f"leg_{row}_{side}_joint" for row in ("front", "middle", "rear") for side in SIDES],
    "side first": [f"{side}_{row}" for row in ("fore", "mid", "hind") for side in SIDES],
    "humps": ["frontLeftHip", "frontRightHip", "centerLeftHip", "centerRightHip", "backLeftHip",
              "backRightHip"],
    "short": [f"{each}_hip" for each in ("FL", "FR", "ML", "MR", "RL", "RR")],
    "short, side first": ["lf", "rf", "lm", "rm", "lr", "rr"],
    "back": ["motor_lb", "motor_rb"],
}  # fmt: skip


@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES)
def test_names_state_their_legs_in_any_order(names):
    first = 5 if names[0] == "motor_lb" else 1
    expected = {name: leg for leg, name in enumerate(names, first)}
    assert legs_of_joints(names) == expected
    assert legs_of_joints([*reversed(names), "gripper"]) == expected


@pytest.mark.parametrize(
    "name", ["leg_0", "leg_7", "leg12", "motor_3", "left", "wheel_left", "", "lr_fl"]
)
def test_other_names_state_nothing(name):
    assert legs_of_joints([name]) == {}


def test_two_joints_of_a_leg_state_nothing():
    """Which of them turns the leg is not to be told from names."""
    assert legs_of_joints(["leg_1_coxa", "leg_1_femur", "leg_2_coxa"]) == {}
    assert legs_of_joints([f"leg_{number}" for number in range(6)] + ["lf"]) == {}
