# SPDX-License-Identifier: MIT
import numpy as np

from benchmarks.accuracy.rigid_engine.arcs import N_SLOTS
from benchmarks.accuracy.rigid_engine.stepping import cross, leg_loads, rotation_of


def test_a_quaternion_turns_as_its_axis_and_angle_say():
    half = np.radians(45.0)
    turned = rotation_of(2 * np.array([np.cos(half), 0.0, 0.0, np.sin(half)]))
    np.testing.assert_allclose(turned @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-15)


def test_the_cross_product_is_numpy_s():
    a, b = np.random.default_rng(1).normal(size=(2, 3))
    np.testing.assert_allclose(cross(a, b), np.cross(a, b))


def test_the_places_of_a_leg_carry_together():
    loads = np.zeros(N_SLOTS)
    loads[0], loads[8], loads[9], loads[19] = 5.0, 1.0, 2.0, 4.0
    np.testing.assert_array_equal(leg_loads(loads), [3.0, 0, 0, 0, 0, 4.0])
