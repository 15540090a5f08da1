# SPDX-License-Identifier: MIT
"""Degrees under the name of radians are found by the path; radians of any path are not."""

import numpy as np
import pytest

from zebro_lab.track.trajectory.table import are_degrees

TURN = np.linspace(0.0, 1.5, 40)


def circle(angle):
    return np.column_stack([np.sin(angle), 1 - np.cos(angle)])


@pytest.mark.parametrize("offset", [0.0, np.pi / 2, np.pi])
@pytest.mark.parametrize("turns", [1, 8])
def test_degrees_are_told_from_radians_whatever_axis_points_ahead(offset, turns):
    angle = turns * TURN
    assert are_degrees(np.degrees(angle + offset), circle(angle))
    assert not are_degrees(angle + offset, circle(angle))


def test_steps_of_nearly_whole_turns_of_radians_are_found_too():
    angle = np.radians(6.5 * np.arange(15))
    assert are_degrees(np.degrees(angle), circle(angle))


def test_wrapped_and_noisy_degrees_are_found():
    rng = np.random.default_rng(1)
    heading = np.degrees(4 * TURN + rng.normal(0, 0.1, len(TURN)))
    wrapped = (heading + 180) % 360 - 180
    assert are_degrees(wrapped, circle(4 * TURN))


def test_a_robot_that_stands_or_turns_on_the_spot_is_not_judged():
    rng = np.random.default_rng(1)
    assert not are_degrees(np.full(40, 88.0), np.zeros((40, 2)))
    assert not are_degrees(20 * TURN, rng.normal(0, 0.01, (40, 2)))
    assert not are_degrees(np.empty(0), np.empty((0, 2)))
