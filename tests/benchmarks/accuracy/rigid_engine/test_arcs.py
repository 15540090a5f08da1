# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.accuracy.rigid_engine.arcs import (
    FLAT,
    N_CORNERS,
    find_places,
    height_at,
    no_places,
    normal_at,
    shape_of,
)
from model.robot import Robot

SHAPE = shape_of(Robot())
R = SHAPE.radius
UP = np.radians(270.0)  # a leg that is in the air
LEVEL = np.eye(3)
BUMPY = FLAT._replace(
    x=-0.5, y=-0.5, step=0.1, z=np.random.default_rng(1).normal(0, 0.01, (11, 11)), highest=0.04,
    rise_x=0.1, rise_y=-0.05,
)  # fmt: skip


def step_up(edge, rise):
    """Return a map of level ground that is higher from an edge across x on; its face is 1 mm."""
    x = edge + 0.001 * np.arange(-200, 201)
    z = np.where(np.arange(401) < 200, 0.0, rise)[:, None] * np.ones(2)
    return FLAT._replace(x=x[0], y=-0.1, step=0.001, z=z, highest=rise)


def touched(theta, heights, z):
    """Return points and normals of the places of leg 1, its hip over the origin at height z."""
    places, legs = no_places(), np.full(6, UP)
    legs[0] = theta
    p = np.array([0.0, 0.0, z]) - SHAPE.hips[0]
    find_places(p, LEVEL, legs, SHAPE, heights, places, np.empty(len(SHAPE.phi)))
    rows = N_CORNERS + np.flatnonzero(places.near[N_CORNERS : N_CORNERS + 2])
    assert not places.near[N_CORNERS + 2 :].any()
    return [(places.point[k], places.normal[k]) for k in rows]


def test_a_leg_rolls_on_its_lowest_point_on_flat_ground():
    theta = np.radians(60.0)
    ((point, normal),) = touched(theta, FLAT, R * (1 + np.sin(theta)))
    np.testing.assert_allclose(point, [R * np.cos(theta), 0.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(normal, [0, 0, 1], atol=1e-4)


def test_a_leg_beyond_the_vertical_stands_on_its_toe():
    theta = np.radians(120.0)
    ((point, normal),) = touched(theta, FLAT, 2 * R * np.sin(theta))
    np.testing.assert_allclose(point, [2 * R * np.cos(theta), 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(normal, [0, 0, 1])


def test_a_leg_on_an_edge_is_pushed_towards_the_centre_of_its_arc():
    theta, ahead = np.radians(30.0), 0.6 * R
    edge = R * np.cos(theta) + ahead
    centre = np.array([R * np.cos(theta), 0.0, 0.05 + 0.8 * R])
    ((point, normal),) = touched(theta, step_up(edge, 0.05), centre[2] + R * np.sin(theta))
    np.testing.assert_allclose(point, [edge, 0.0, 0.05], atol=1e-6)
    np.testing.assert_allclose(normal, (centre - point) / R, atol=1e-4)


def test_a_leg_touches_at_two_places_at_the_foot_of_a_step():
    theta = np.radians(30.0)
    rise = 0.2 * R  # of an edge 0.6 r ahead: as high as the arc there
    step = step_up(R * np.cos(theta) + 0.6 * R, rise)
    points = [point for point, _ in touched(theta, step, R * (1 + np.sin(theta)))]
    assert sorted(point[2] for point in points) == pytest.approx([0.0, rise], abs=1e-6)


def test_the_normal_is_square_to_the_heights():
    for x, y in np.random.default_rng(2).uniform(-0.7, 0.7, (50, 2)):
        h = 1e-7
        slopes = [(height_at(BUMPY, x + h, y) - height_at(BUMPY, x - h, y)) / (2 * h),
                  (height_at(BUMPY, x, y + h) - height_at(BUMPY, x, y - h)) / (2 * h)]  # fmt: skip
        normal = np.array(normal_at(BUMPY, x, y))
        np.testing.assert_allclose(normal[:2] / normal[2], [-slopes[0], -slopes[1]], atol=1e-5)
        assert np.linalg.norm(normal) == pytest.approx(1.0)


def test_a_body_that_lies_on_the_ground_touches_by_its_lower_corners():
    places = no_places()
    p = np.array([0.0, 0.0, 0.0345])
    find_places(p, LEVEL, np.full(6, UP), SHAPE, FLAT, places, np.empty(len(SHAPE.phi)))
    assert places.near[:N_CORNERS].sum() == 4
    assert (places.point[:N_CORNERS][places.near[:N_CORNERS], 2] == 0.0).all()
