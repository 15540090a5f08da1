# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import GRAVITY, Robot
from model.slip import MagicFormula
from model.walk.areas import Area, area_at, law_at, require_polygon, with_areas
from model.walk.dynamics import walk
from model.walk.traction import VelocityCoulomb, law_table

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
COULOMB = VelocityCoulomb(0.38).table(weight=WEIGHT)
ICE = VelocityCoulomb(0.05).table(weight=WEIGHT)
CURVE = law_table(
    MagicFormula("peak"), np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066]), weight=WEIGHT
)
TURN = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0)
EVERYWHERE = np.array([[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]])
ELL = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])


def walked(table):
    return walk(ROBOT, TURN, table, duration=3.0)


@pytest.mark.parametrize("law", [COULOMB, CURVE])
def test_an_area_that_covers_all_is_the_walk_on_its_law(law):
    over = walked(with_areas(ICE, [Area(EVERYWHERE, law)]))
    alone = walked(law)
    np.testing.assert_allclose(over.position, alone.position, atol=1e-9)
    np.testing.assert_allclose(over.traction_force, alone.traction_force, atol=1e-6)


def test_an_area_that_no_leg_comes_to_changes_nothing():
    beyond = walked(with_areas(CURVE, [Area(EVERYWHERE + 100.0, ICE)]))
    np.testing.assert_allclose(beyond.position, walked(CURVE).position, atol=1e-9)


def test_legs_on_ice_have_the_traction_of_ice_and_others_that_of_the_ground():
    left = np.array([[-9.0, 0.0], [9.0, 0.0], [9.0, 9.0], [-9.0, 9.0]])
    path = walk(ROBOT, TURN, with_areas(COULOMB, [Area(left, ICE)]), duration=1.0)
    used = np.linalg.norm(path.traction_force, axis=2)[path.t > 0.05]
    most = used.max(axis=0) / WEIGHT
    load = path.normal_force[path.t > 0.05]
    on_left = ROBOT.hips[:, 1] > 0
    assert np.all(used[:, on_left] <= 0.06 * load[:, on_left] + 1e-9)  # loads of a step are guesses
    assert most[~on_left].max() > 0.2


def test_single_steps_exceed_friction_by_next_to_no_impulse():
    # velocities settle within 0.3 mm/s, and the law rises over 1 mm/s
    path = walked(
        with_areas(COULOMB, [Area(EVERYWHERE, VelocityCoulomb(0.1).table(weight=WEIGHT))])
    )
    allowed = 0.1 * path.normal_force
    beyond = np.maximum(np.linalg.norm(path.traction_force, axis=2) - allowed, 0.0)
    assert (beyond > 0.02 * allowed).mean() < 0.005
    assert beyond.sum() < 5e-4 * allowed.sum()


def test_the_last_of_overlapping_areas_counts():
    laws = with_areas(COULOMB, [Area(EVERYWHERE, CURVE), Area(ELL, ICE)])
    assert [area_at(laws, x, y) for x, y in ((0.5, 0.5), (1.5, 1.5), (20.0, 0.0))] == [2, 1, 0]


@given(st.floats(-0.5, 2.5), st.floats(-0.5, 2.5))
def test_places_in_a_polygon_with_a_corner_inwards_are_found(x, y):
    laws = with_areas(COULOMB, [Area(ELL, ICE)])
    inside = 0 < x < 2 and 0 < y < 2 and not (x > 1 and y > 1)
    edges = np.array([x, x - 1, x - 2, y, y - 1, y - 2])
    if np.abs(edges).min() > 1e-9:
        assert area_at(laws, x, y) == inside
        assert law_at(laws, np.array([x, 0.0, 0.0]), np.array([0.0, y, 0.0])).toe[0] == (
            pytest.approx(0.05 if inside else 0.38)
        )


# --- refused


@pytest.mark.parametrize(
    ("corners", "message"),
    [
        ([[0, 0], [1, 0]], "found 2 corners; expected three or more"),
        ([[0, 0], [1, 0], [1, np.nan]], "of finite x and y"),
        ([[0, 0], [1, 0], [1, 1], [0, 0]], "corner 4, x 0, y 0 m, is the same as the next"),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "edges from corner 1 and from corner 3 cross"),
        ([[0, 0], [1, 1], [2, 2]], "lie on one line"),
    ],
)
def test_corners_that_enclose_no_area_are_refused(corners, message):
    with pytest.raises(DomainError, match=message):
        require_polygon(np.array(corners, dtype=float))


def test_toes_that_stick_on_some_areas_only_are_refused():
    sticky = VelocityCoulomb(0.38).table(weight=WEIGHT, toe="bristle")
    with pytest.raises(DomainError, match="stick like springs on some areas only"):
        with_areas(COULOMB, [Area(ELL, sticky)])


def test_laws_of_different_loads_are_refused():
    light = law_table(
        MagicFormula("peak"), np.array([20.0, 1.564, 0.3798, 0.0066]), weight=WEIGHT / 2
    )
    with pytest.raises(DomainError, match="tabulated at different loads"):
        with_areas(CURVE, [Area(ELL, light)])
