# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import DomainError
from model.slip.load_curves import LoadCurve, curves_by_load


def test_points_of_two_loads_are_two_curves_sorted_by_slip():
    slip = np.array([0.2, 0.1, 0.0, 0.1, 0.2, 0.0])
    load = np.array([5.0, 5.1, 4.9, 12.0, 12.1, 11.9])
    light, heavy = curves_by_load(slip, load, slip * load)
    assert (light.load, heavy.load) == (5.0, 12.0)
    np.testing.assert_array_equal(light.slip, [0.0, 0.1, 0.2])
    np.testing.assert_allclose(light.force, [0.0, 0.5, 1.0])  # all scaled to 5 N


def test_points_belong_to_the_nearest_of_stated_loads():
    load = np.array([4.0, 4.6, 5.2, 9.0])
    light, heavy = curves_by_load(np.arange(4.0), load, load, levels=np.array([9.0, 4.5]))
    assert (light.load, heavy.load) == (4.6, 9.0)
    np.testing.assert_allclose(light.force, 4.6)


def test_repeated_points_are_averaged():
    (curve,) = curves_by_load(
        np.array([0.0, 0.1, 0.10001, 0.5]), np.full(4, 5.0), np.array([0.0, 1.0, 2.0, 1.8])
    )
    np.testing.assert_allclose(curve.slip, [0.0, 0.100005, 0.5])
    np.testing.assert_allclose(curve.force, [0.0, 1.5, 1.8])
    (single,) = curves_by_load(np.full(3, 0.1), np.full(3, 5.0), np.array([1.0, 2.0, 3.0]))
    assert (single.slip, single.force) == ([pytest.approx(0.1)], [2.0])


def test_a_curve_of_driving_alone_is_odd_and_unknown_beyond_its_points():
    curve = LoadCurve(5.0, np.array([0.1, 0.2]), np.array([1.0, 1.5]))
    found = curve.force_at(np.array([-0.15, -0.05, 0.0, 0.05, 0.2, 0.3]))
    np.testing.assert_allclose(found, [-1.25, -0.5, 0.0, 0.5, 1.5, np.nan])


def test_both_sides_of_a_curve_are_kept_apart():
    curve = LoadCurve(5.0, np.array([-0.2, -0.1, 0.0, 0.1]), np.array([-3.0, -2.0, 0.0, 1.0]))
    np.testing.assert_array_equal(curve.driving().force, [0.0, 1.0])
    np.testing.assert_array_equal(curve.braking().slip, [0.0, 0.1, 0.2])
    np.testing.assert_array_equal(curve.braking().force, [0.0, 2.0, 3.0])
    assert curve.force_at(np.array([-0.15, 0.2])) == pytest.approx([-2.5, np.nan], nan_ok=True)


@pytest.mark.parametrize("load", [[], [0.0]])
def test_points_without_load_are_refused(load):
    with pytest.raises(DomainError, match="positive loads"):
        curves_by_load(np.zeros(len(load)), np.array(load), np.zeros(len(load)))
