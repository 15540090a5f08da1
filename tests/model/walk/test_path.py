# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.walk.path import WalkPath, turning_radius


@given(radius=st.floats(0.1, 100.0), turn=st.floats(0.01, 12.0), left=st.booleans())
def test_the_radius_of_a_circle_is_its_radius_with_the_sign_of_the_turn(radius, turn, left):
    near_whole = abs(turn / (2 * np.pi) - round(turn / (2 * np.pi))) < 1e-3
    if near_whole and turn > 1:
        return  # the chord vanishes
    sign = 1 if left else -1
    yaw = sign * np.linspace(0.3, 0.3 + turn, 50)
    xy = sign * radius * np.column_stack([np.sin(yaw), -np.cos(yaw)])
    assert turning_radius(xy, yaw) == pytest.approx(sign * radius, rel=1e-6)


def test_a_straight_line_has_no_finite_radius():
    assert turning_radius(np.array([[0.0, 0], [1, 0]]), np.zeros(2)) == np.inf


def test_a_part_keeps_every_column_and_the_length_is_that_over_the_ground():
    n = 5
    path = WalkPath(
        t=np.arange(n), position=np.outer(np.arange(n), [3.0, 4.0, 1.0]),
        orientation=np.zeros((n, 3)), theta=np.zeros((n, 6)), contact=np.ones((n, 6), dtype=bool),
        slip_velocity=np.zeros((n, 6, 2)), slip_ratio=np.zeros((n, 6)),
        normal_force=np.zeros((n, 6)), traction_force=np.zeros((n, 6, 2)),
    )  # fmt: skip
    assert path.length == pytest.approx(20.0)
    half = path.part(slice(0, 3))
    assert half.length == pytest.approx(10.0)
    assert {len(column) for column in vars(half).values()} == {3}
