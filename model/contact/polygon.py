# SPDX-License-Identifier: MIT
"""The contact triangle (support polygon of three legs), and static stability of a point in it."""

import numpy as np
from numba.extending import register_jitable

from model.arrays import Array


def side_products(point: Array, triangle: Array) -> Array:
    r"""Compute on which side of a triangle's three sides a point lies, Eq. (3-30) to (3-32) [m4].

    .. math::
        \bigl((B - A) \times (p - A)\bigr) \cdot \bigl((B - A) \times (C - A)\bigr)

    Eq. (3-29): with AB the side across from corner C, positive when p lies on C's side of it.

    Args:
        point: p, the centre of mass seen from above, shape (2,) [m].
        triangle: Contact points seen from above, shape (3, 2) [m].

    Returns:
        Product for the side opposite each corner, shape (3,); negative beyond that side, all zero
        when the corners lie on a line.
    """
    products = np.empty(3)
    for corner in range(3):
        a, b = triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]
        side = b - a
        of_point = side[0] * (point[1] - a[1]) - side[1] * (point[0] - a[0])
        of_corner = side[0] * (triangle[corner, 1] - a[1]) - side[1] * (triangle[corner, 0] - a[0])
        products[corner] = of_point * of_corner
    return products


def depth_in_triangle(point: Array, triangle: Array) -> float:
    """Compute the signed distance from a point in a triangle to the triangle's nearest side [m].

    Of the centre of mass it is the static stability margin. Outside it is negative, to the line of
    the side that the point lies furthest beyond.

    Args:
        point: The point seen from above, shape (2,) [m].
        triangle: The corners seen from above, shape (3, 2) [m].

    Returns:
        Least distance to the sides' lines [m]; minus infinity when the corners lie on a line.
    """
    products = side_products(point, triangle)
    across = triangle[1] - triangle[0]
    onward = triangle[2] - triangle[0]
    double_area = abs(across[0] * onward[1] - across[1] * onward[0])
    if double_area == 0.0:
        return -np.inf
    depth = np.inf
    for corner in range(3):
        side = triangle[(corner + 2) % 3] - triangle[(corner + 1) % 3]
        length = np.sqrt(side[0] ** 2 + side[1] ** 2)
        depth = min(depth, products[corner] / (double_area * length))
    return depth


for _function in (side_products, depth_in_triangle):
    register_jitable(_function)


def contains(point: Array, triangle: Array) -> bool:
    """Return whether a point lies in a triangle or on its edge, Eq. (3-30) to (3-32).

    True for every point when the corners lie on a line.

    Args:
        point: The point seen from above, shape (2,) [m].
        triangle: The corners seen from above, shape (3, 2) [m].

    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    >>> contains(np.array([0.2, 0.2]), corners), contains(np.array([0.8, 0.8]), corners)
    (True, False)
    """
    return bool(np.all(side_products(point, triangle) >= 0))
