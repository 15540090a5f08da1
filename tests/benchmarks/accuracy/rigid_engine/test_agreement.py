# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.accuracy.rigid_engine.agreement import Motion, agreement, length, whole_turn

T = np.linspace(0.0, 10.0, 1001)


def arc(rate=0.1, t=T, load=1.0):
    yaw = rate * t
    xy = np.column_stack([np.sin(yaw), 1 - np.cos(yaw)]) * 0.1 / rate
    return Motion(t, xy, yaw, np.full((len(t), 6), load))


def test_a_walk_agrees_with_itself_at_other_times():
    errors = agreement(arc(t=np.linspace(0.0, 10.0, 4001)), arc())
    assert errors.path < 1e-6
    assert errors.heading < 1e-6
    assert errors.contacts == 1.0


def test_errors_are_shares_of_length_and_turn():
    walk = arc()
    aside = Motion(T, walk.xy + np.array([0.0, 0.03]), walk.yaw + 0.02, walk.load)
    errors = agreement(aside, walk)
    assert errors.path == pytest.approx(0.03, rel=1e-3)
    assert errors.heading == pytest.approx(0.02, rel=1e-3)


def test_turns_to_both_sides_add_up():
    yaw = 0.5 * np.sin(np.pi * T / 5)
    walk = Motion(T, arc().xy, yaw, arc().load)
    assert whole_turn(walk) == pytest.approx(2.0, rel=0.02)
    assert length(walk) == pytest.approx(1.0, rel=1e-3)


def test_a_leg_in_the_air_for_a_tenth_of_the_time_costs_a_tenth_of_its_contact():
    walk = arc()
    lifted = walk.load.copy()
    lifted[500:600, 2] = 0.0
    errors = agreement(Motion(T, walk.xy, walk.yaw, lifted), walk)
    assert errors.contacts == pytest.approx(1 - 0.1 / 6, abs=1e-3)


def test_a_walk_without_a_turn_has_no_error_of_heading():
    assert np.isnan(agreement(arc(1e-4), arc(1e-4)).heading)
