# SPDX-License-Identifier: MIT
"""Legs that turn faster than the robot's are warned of."""

import numpy as np
import pytest

from model.gait import SampledReference, tripod_angles, tripod_reference
from zebro_lab.walk.notes import largest_speeds, speed_warnings

FAST = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0)


def test_largest_speeds_of_a_gait_are_those_of_its_angles():
    t = np.linspace(0.0, 4.0, 2001)
    sampled = SampledReference(t, FAST.angles(t))
    np.testing.assert_allclose(largest_speeds(FAST), largest_speeds(sampled), rtol=1e-9)


def test_a_leg_faster_than_the_limit_is_named_and_one_at_the_limit_is_not():
    fastest = float(largest_speeds(FAST).max())
    assert speed_warnings(FAST, None) == speed_warnings(FAST, fastest) == ()
    (line,) = speed_warnings(FAST, np.radians(200.0))
    for part in ("WARNING: leg 1", "292 deg/s", "200 deg/s", "legs.speed_limit_deg_per_s"):
        assert part in line


@pytest.mark.parametrize("limit", ["4", "0", "-300"])
def test_an_improbable_limit_is_refused(limit, run_command, tmp_path):
    robot = tmp_path / "robot.toml"
    robot.write_text(f"[legs]\nspeed_limit_deg_per_s = {limit}\n")
    ended = run_command("walk", "--slip", "thesis", "--duration", 2, "--robot", robot)
    assert ended.code == 1
    assert "speed_limit_deg_per_s: is" in ended.err
