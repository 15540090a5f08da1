# SPDX-License-Identifier: MIT
"""Values of a plan: the ground disc's speed of a slip ratio, and limits that combine."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.slip.definition import SlipDefinition, slip_ratio
from rig.device import Limits
from rig.experiment.plan import ground_speed, rig_limits

RADII = {"radius_leg": 0.035, "radius_ground": 0.12}
ALLOWED = Limits(speed=40.0, normal_force=20.0, traction_force=20.0, torque=2.0)


@given(st.floats(-3, 1), st.floats(0.1, 50))
def test_the_ground_discs_speed_makes_the_slip_ratio_that_was_asked_for(slip, omega):
    ground = ground_speed(slip, omega, **RADII)
    speeds = (omega * RADII["radius_leg"], ground * RADII["radius_ground"])
    assert slip_ratio(*speeds, SlipDefinition.MATERIAL) == pytest.approx(slip, abs=1e-9)


def test_at_slip_1_the_ground_disc_stands():
    assert ground_speed(1.0, 12.0, **RADII) == 0.0


def test_of_a_plans_and_a_rigs_limits_the_smaller_counts(lab):
    limits = replace(lab["plan"]().limits, speed=50.0, normal_force=10.0, torque=None,
                     lateral_force=3.0, temperature_celsius=None)  # fmt: skip
    both = rig_limits(limits, ALLOWED)
    assert (both.speed, both.normal_force) == (40.0, 10.0)
    assert (both.torque, both.lateral_force, both.temperature_celsius) == (2.0, 3.0, None)
