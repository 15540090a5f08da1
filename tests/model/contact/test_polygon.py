# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from model.contact.polygon import contains, depth_in_triangle, side_products

COORDINATE = st.floats(-1.0, 1.0)
POINT = st.tuples(COORDINATE, COORDINATE).map(np.array)
TRIANGLE = st.tuples(POINT, POINT, POINT).map(np.array)
RIGHT_ANGLED = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]])


def barycentric(point, triangle):
    system = np.vstack([triangle.T, np.ones(3)])
    return np.linalg.solve(system, np.append(point, 1.0))


def area(triangle):
    u, v = triangle[1] - triangle[0], triangle[2] - triangle[0]
    return 0.5 * abs(u[0] * v[1] - u[1] * v[0])


@given(POINT, TRIANGLE)
def test_a_point_is_inside_when_no_weight_is_negative(point, triangle):
    assume(area(triangle) > 1e-3)
    weights = barycentric(point, triangle)
    assume(np.abs(weights).min() > 1e-9)
    assert contains(point, triangle) == bool(np.all(weights > 0))
    assert np.array_equal(side_products(point, triangle) > 0, weights > 0)


@given(POINT, TRIANGLE, st.permutations([0, 1, 2]))
def test_the_order_of_corners_does_not_matter(point, triangle, order):
    assume(area(triangle) > 1e-3)
    shuffled = triangle[list(order)]
    assert depth_in_triangle(point, shuffled) == pytest.approx(depth_in_triangle(point, triangle))


@pytest.mark.parametrize(
    ("point", "depth"), [((1.0, 1.0), 1.0), ((0.5, 1.0), 0.5), ((-0.25, 1.0), -0.25)]
)
def test_depth_is_the_distance_to_the_nearest_side(point, depth):
    assert depth_in_triangle(np.array(point), RIGHT_ANGLED) == pytest.approx(depth)


def test_three_points_on_a_line_hold_nothing():
    line = np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]])
    assert depth_in_triangle(np.array([0.5, 0.5]), line) == -np.inf
