# SPDX-License-Identifier: MIT

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import GRAVITY, Robot
from model.walk.dynamics import Start, walk
from model.walk.ground import FLAT, beyond_grid, ground_at, height_and_slopes, is_level, with_slope
from model.walk.traction import VelocityCoulomb
from support.grounds import sample_ground

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
HILLS = sample_ground(
    lambda x, y: 0.02 * np.sin(5 * x) * np.cos(3 * y), x=(-1, 1), y=(-1, 1), step=0.01
)
PLACE = st.floats(-0.99, 0.99)


def slope(angle, *, size=2.0):
    return sample_ground(lambda x, y: np.tan(angle) * x, x=(-size, size), y=(-1.0, 1.0))


# --- heights


@given(PLACE, PLACE)
def test_heights_are_the_functions(x, y):
    height = ground_at(HILLS, x, y)[0]
    assert height == pytest.approx(0.02 * np.sin(5 * x) * np.cos(3 * y), abs=2e-5)


@given(PLACE, PLACE)
def test_the_normal_is_square_to_the_surface(x, y):
    h = 1e-7
    height, *normal = ground_at(HILLS, x, y)
    assert np.linalg.norm(normal) == pytest.approx(1.0)
    in_cell = ((np.array([x, y]) + 1) / 0.01) % 1
    if np.all((in_cell > 1e-4) & (in_cell < 1 - 1e-4)):
        for dx, dy in ((h, 0), (0, h)):
            along = np.array([dx, dy, ground_at(HILLS, x + dx, y + dy)[0] - height])
            assert abs(along @ normal) < 1e-6 * h + 1e-14


@pytest.mark.parametrize(("x", "y"), [(5.0, 0.0), (-5.0, 0.0)])
def test_beyond_the_area_the_edge_goes_on_level(x, y):
    height, *normal = ground_at(slope(0.3), x, y)
    assert height == pytest.approx(np.sign(x) * 2.0 * np.tan(0.3), abs=1e-5)
    np.testing.assert_allclose(normal, [0, 0, 1])


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_plane_and_grid_add_up(x, y):
    alone = (HILLS, with_slope(FLAT, 0.1, -0.2))
    parts = np.sum([height_and_slopes(each, x, y) for each in alone], axis=0)
    together = with_slope(HILLS, 0.1, -0.2)
    np.testing.assert_allclose(height_and_slopes(together, x, y), parts, atol=1e-12)


def test_places_beyond_a_grid_are_told():
    x, y = np.array([0.0, 1.01, -0.5, 0.0]), np.array([0.0, 0.0, -1.01, 0.99])
    assert beyond_grid(HILLS, x, y).tolist() == [False, True, True, False]
    assert not beyond_grid(FLAT, x, y).any()


def test_only_a_level_plane_is_level():
    assert is_level(FLAT)
    assert not any(map(is_level, (HILLS, with_slope(FLAT, 0.0, 0.01))))


# --- walking on it


@pytest.mark.parametrize("angle", [-0.3, -0.1, 0.2, 0.3])
def test_legs_that_roll_up_a_slope_roll_as_far_as_on_the_flat(angle):
    sticky = VelocityCoulomb(2.0, 1e-4).table(weight=WEIGHT)
    theta = np.tile(np.radians([[20.0], [20.0], [80.0]]), (1, 6))
    rolled = SampledReference(np.array([0.0, 0.2, 1.2]), theta)

    def moved(ground):
        path = walk(ROBOT, rolled, sticky, duration=1.2, ground=ground)
        along = path.position[-1] - path.position[200]
        return np.linalg.norm(along), path.orientation[-1, 1]

    flat, _ = moved(FLAT)
    up, pitch = moved(slope(angle))
    assert up == pytest.approx(flat, rel=5e-4)
    assert pitch == pytest.approx(-angle, abs=1e-4)


def standing(theta):
    return SampledReference(np.array([0.0, 1.0]), np.full((2, 6), theta))


def test_a_robot_slides_where_a_slope_is_too_steep():
    table = VelocityCoulomb(0.38).table(weight=WEIGHT)
    path = walk(ROBOT, standing(0.5 * np.pi), table, duration=1.0, ground=slope(0.5))
    run = np.linalg.norm(path.position[-1] - path.position[0])
    free = GRAVITY * (np.sin(0.5) - 0.38 * np.cos(0.5))
    assert run == pytest.approx(0.5 * free, rel=0.03)
    # What carries it is square to the slope, and friction is used up.
    assert path.normal_force[-1].sum() == pytest.approx(WEIGHT * np.cos(0.5), rel=0.01)
    assert path.traction_force[-1, :, 0].sum() == pytest.approx(
        0.38 * WEIGHT * np.cos(0.5) ** 2, rel=0.01
    )


def test_toes_that_do_not_stick_creep_down_a_slope_by_the_laws_velocity():
    table = VelocityCoulomb(0.38).table(weight=WEIGHT)
    path = walk(ROBOT, standing(np.radians(130.0)), table, duration=1.0, ground=slope(0.2))
    late = path.t > 0.9
    ends = path.position[late][[0, -1]]
    speed = np.linalg.norm(ends[1] - ends[0]) / np.ptp(path.t[late])
    used = np.tan(0.2) / 0.38
    assert speed == pytest.approx(0.001 * used / np.sqrt(1 - used**2), rel=0.01)


SLIPPERY = VelocityCoulomb(0.38).table(weight=WEIGHT)
TRIPOD = tripod_reference(tripod_angles(np.radians(50.0)), 1.0)


@pytest.mark.parametrize(("along_x", "along_y"), [(5.0, 0.0), (-3.0, 4.0)])
def test_a_walk_on_a_plane_of_heights_is_that_on_the_plane(along_x, along_y):
    sx, sy = np.tan(np.radians([along_x, along_y]))
    heights = sample_ground(lambda x, y: sx * x + sy * y, x=(-1.0, 2.0), y=(-1.0, 1.0))
    plane = with_slope(FLAT, *np.radians([along_x, along_y]))
    on_heights, on_plane = (
        walk(ROBOT, TRIPOD, SLIPPERY, duration=4.0, ground=each) for each in (heights, plane)
    )
    away = np.linalg.norm(on_heights.position - on_plane.position, axis=1)
    assert away.max() < 0.002 * on_plane.length
    assert np.mean(on_heights.contact == on_plane.contact) > 0.99


def test_a_walk_up_a_slope_is_that_of_a_robot_turned_about_with_the_slope():
    up = walk(ROBOT, TRIPOD, SLIPPERY, duration=2.0, ground=with_slope(FLAT, np.radians(5.0), 0.0))
    turned = walk(
        ROBOT, TRIPOD, SLIPPERY, duration=2.0, ground=with_slope(FLAT, np.radians(-5.0), 0.0),
        start=Start(yaw=np.pi),
    )  # fmt: skip
    there, back = up.position[-1], turned.position[-1]
    np.testing.assert_allclose(back, there * [-1.0, -1.0, 1.0], atol=1e-6)


def test_a_robot_climbs_a_step_and_stands_higher_by_it():
    step = sample_ground(
        lambda x, y: 0.01 * np.clip((x - 0.25) / 0.005, 0, 1) + 0 * y, x=(-1, 1), y=(-1, 1)
    )
    flat, stepped = (
        walk(ROBOT, TRIPOD, SLIPPERY, duration=5.0, ground=each) for each in (FLAT, step)
    )
    assert flat.position[-1, 0] > 0.5
    assert stepped.position[-1, 0] == pytest.approx(flat.position[-1, 0], rel=0.05)
    raised = np.mean(stepped.position[-500:, 2]) - np.mean(flat.position[-500:, 2])
    assert raised == pytest.approx(0.01, abs=0.0005)


# --- refused


def test_a_slope_too_steep_to_find_contacts_from_above_is_refused():
    with pytest.raises(DomainError, match="slope along y is 46 degrees; expected -45 to 45"):
        with_slope(FLAT, 0.0, np.radians(46.0))
