# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from model.errors import DomainError, WalkError
from model.gait.reference import SampledReference
from model.robot import Robot
from model.slip import MagicFormula
from model.walk.dynamics import DynamicsOptions, Start, walk
from model.walk.ground import Ground
from model.walk.no_slip import walk_no_slip
from model.walk.path import turning_radius
from model.walk.traction import VelocityCoulomb, law_table
from support.grounds import sample_ground

ROBOT = Robot()
WEIGHT = ROBOT.mass * 9.81
SOURCE = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
SLIP = law_table(MagicFormula("peak"), SOURCE, weight=WEIGHT)
COULOMB = VelocityCoulomb(0.38).table(weight=WEIGHT)
CYCLE = 2.0
INNER, OUTER = (50.0, 117.9909), (37.8366, 126.2247)  # steering factor 1.3, matched hip heights
STRAIGHT = (50.0, 117.9909)


def tripod(inner=INNER, outer=OUTER, *, left=True, cycle=CYCLE, cycles=14):
    """Return a tripod gait from touchdown and lift-off angles in degrees."""
    t = cycle / 2 * np.arange(2 * cycles + 1)
    k = np.arange(len(t))
    theta = np.empty((len(t), 6))
    for leg in range(6):
        down, off = np.radians(inner if (leg % 2 == 0) == left else outer)
        turns = 2 * np.pi * (k // 2)
        if leg in (0, 3, 4):
            theta[:, leg] = np.where(k % 2 == 0, down, off) + turns
        else:
            theta[:, leg] = np.where(k % 2 == 0, off, down + 2 * np.pi) + turns
    return SampledReference(t, theta)


def standing(theta=np.pi / 2):
    return SampledReference(np.array([0.0, 1.0]), np.full((2, 6), theta))


def radius(path, dt, *, first=1, last=7):
    at = [round(n * CYCLE / dt) for n in (first, last)]
    return turning_radius(path.position[at, :2], path.yaw[at])


def turn(dt=0.005, table=SLIP, robot=ROBOT, **options):
    path = walk(
        robot, tripod(), table, duration=7 * CYCLE, options=DynamicsOptions(dt=dt, **options)
    )
    return radius(path, dt)


# --- converged, and in what


def test_the_radius_converges_in_the_step():
    fine = turn(dt=0.0002)
    for dt in (0.005, 0.002, 0.001, 0.0005):
        assert turn(dt=dt) == pytest.approx(fine, rel=0.003)


def test_smooth_motion_converges_with_the_first_order_of_the_step():
    def end(dt):
        sliding = walk(
            ROBOT, standing(), COULOMB, duration=0.1, start=Start(velocity=(0.3, 0.1, 0.0)),
            options=DynamicsOptions(dt=dt),
        )  # fmt: skip
        return sliding.position[-1, 0]

    exact = end(0.0005 / 64)
    steps = np.array([0.0005, 0.00025, 0.000125])
    errors = np.array([abs(end(dt) - exact) for dt in steps])
    order = np.log2(errors[:-1] / errors[1:])
    assert np.all(order > 0.8)


@pytest.mark.parametrize(
    "change", [{"stiffness": 4e5}, {"stiffness": 1e5}, {"damping": 400.0}, {"damping": 100.0}]
)
def test_the_radius_does_not_depend_on_how_hard_contacts_are(change):
    assert turn(**change) == pytest.approx(turn(), rel=0.003)


def test_slip_does_not_chatter():
    for dt in (0.005, 0.001):
        path = walk(ROBOT, tripod(), SLIP, duration=3 * CYCLE, options=DynamicsOptions(dt=dt))
        slip = path.slip_ratio
        changes = np.sum(slip[1:] * slip[:-1] < 0, axis=0)
        contact_time = path.contact.sum(axis=0) * dt
        assert np.all(changes / contact_time <= 10)


# --- grip


def test_with_matched_hip_heights_the_radius_does_not_depend_on_grip():
    radii = [
        turn(table=law_table(MagicFormula("peak"), SOURCE * [mu / 0.3798, 1, mu / 0.3798, 1],
                             weight=WEIGHT))
        for mu in (0.2, 0.38, 0.7)
    ]  # fmt: skip
    np.testing.assert_allclose(radii, radii[1], rtol=0.003)


def test_combined_slip_widens_the_turn_of_exact_leg_kinematics():
    # No-slip kinematics turn in 0.99 m at this steering factor.
    assert 1.15 < turn() < 1.20


# --- symmetry


@pytest.mark.parametrize(("cycle", "shorter"), [(0.35, (0.02, 0.05)), (2.0, (-1e-3, 1e-3))])
def test_a_slow_straight_walk_is_kinematics_and_a_fast_one_flies_and_slips(cycle, shorter):
    legs = tripod(STRAIGHT, STRAIGHT, cycle=cycle, cycles=6)
    exact = walk_no_slip(ROBOT, legs, duration=6 * cycle, dt=0.0005).position[-1, 0]
    path = walk(ROBOT, legs, SLIP, duration=6 * cycle, options=DynamicsOptions(dt=0.0005))
    assert shorter[0] < 1 - path.position[-1, 0] / exact < shorter[1]
    assert bool(path.in_flight.mean() > 0.01) is (cycle < 1)


def test_left_and_right_mirror():
    left = walk(ROBOT, tripod(), SLIP, duration=6.0)
    right = walk(ROBOT, tripod(left=False), SLIP, duration=6.0)
    # Legs 1, 4, 5 start either way; mirrored, the other tripod would, so compare shifted by half.
    swapped = SampledReference(tripod().t, tripod().theta[:, [1, 0, 3, 2, 5, 4]])
    mirror = walk(ROBOT, swapped, SLIP, duration=6.0)
    np.testing.assert_allclose(mirror.position[:, 0], left.position[:, 0], atol=1e-9)
    np.testing.assert_allclose(mirror.position[:, 1], -left.position[:, 1], atol=1e-9)
    np.testing.assert_allclose(mirror.orientation * [-1, 1, -1], left.orientation, atol=1e-9)
    np.testing.assert_allclose(
        mirror.normal_force[:, [1, 0, 3, 2, 5, 4]], left.normal_force, atol=1e-5
    )
    assert right.yaw[-1] < 0 < left.yaw[-1]


@pytest.mark.parametrize("heading", [0.5 * np.pi, np.pi, -0.5 * np.pi, 1.0])
def test_compass_headings_agree(heading):
    north = walk(ROBOT, tripod(), SLIP, duration=6.0)
    other = walk(ROBOT, tripod(), SLIP, duration=6.0, start=Start(yaw=heading))
    c, s = np.cos(heading), np.sin(heading)
    turned = north.position @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    np.testing.assert_allclose(other.position, turned, atol=1e-9)
    np.testing.assert_allclose(
        np.unwrap(other.yaw) - other.yaw[0], north.yaw - north.yaw[0], atol=1e-9
    )


def test_the_same_walk_twice_is_the_same_to_the_bit():
    one, same = (walk(ROBOT, tripod(), SLIP, duration=2.0) for _ in range(2))
    np.testing.assert_array_equal(one.position, same.position)


# --- forces and energy


def test_standing_legs_carry_the_weight():
    path = walk(ROBOT, standing(), SLIP, duration=0.5)
    np.testing.assert_allclose(path.normal_force[-1].sum(), WEIGHT, rtol=1e-6)
    np.testing.assert_allclose(path.position[-1], [0, 0, 0.07], atol=1e-4)
    np.testing.assert_allclose(path.orientation[-1], 0, atol=1e-5)


def test_a_standing_robot_is_in_contact_from_the_first_sample():
    path = walk(ROBOT, standing(), SLIP, duration=0.1)
    assert path.contact[0].all()
    assert path.normal_force[0].sum() == pytest.approx(WEIGHT, rel=1e-3)


def test_a_leg_sinks_micrometres():
    path = walk(ROBOT, standing(), SLIP, duration=0.5)
    assert 0 < 0.07 - path.position[-1, 2] < 100e-6


def test_impulse_is_the_change_of_momentum():
    dt = 0.0005
    path = walk(ROBOT, tripod(), SLIP, duration=3.0, options=DynamicsOptions(dt=dt))
    velocity = np.diff(path.position, axis=0) / dt
    c, s = np.cos(path.yaw)[:, None], np.sin(path.yaw)[:, None]
    forward, left = path.traction_force[..., 0], path.traction_force[..., 1]
    force = np.stack(
        [(c * forward - s * left).sum(1), (s * forward + c * left).sum(1),
         path.normal_force.sum(1) - WEIGHT], axis=1
    )  # fmt: skip
    # Forces are kept at each step's end; fine steps within it are not.
    impulse = np.cumsum(force[2:] * dt, axis=0) / ROBOT.mass
    gained = velocity[1:] - velocity[0]
    assert np.abs(impulse - gained).max() < 2e-4


def test_traction_opposes_slip_and_stays_within_friction():
    path = walk(ROBOT, tripod(), SLIP, duration=4.0)
    power = np.sum(path.traction_force * path.slip_velocity, axis=2)
    assert power.max() <= 0
    size = np.linalg.norm(path.traction_force, axis=2)
    used = size[path.contact] / (0.3798 * path.normal_force[path.contact])
    # The secant follows slip by a step, which shows where a contact has just begun or ended.
    assert np.mean(used > 1.002) < 0.001
    assert used.max() < 1.3
    assert np.all(path.normal_force >= 0)


def test_a_sliding_robot_comes_to_rest_at_the_distance_friction_says():
    path = walk(
        ROBOT, standing(), COULOMB, duration=0.5, start=Start(velocity=(0.5, 0.0, 0.0)),
        options=DynamicsOptions(dt=0.0002),
    )  # fmt: skip
    assert path.position[-1, 0] == pytest.approx(0.5**2 / (2 * 0.38 * 9.81), rel=0.02)


def energy(path, dt):
    """Kinetic and potential energy between samples; what contacts store is left out, and not
    negative."""
    velocity = np.diff(path.position, axis=0) / dt
    turned = Rotation.from_euler("ZYX", path.orientation[:, ::-1])
    spin = (turned[:-1].inv() * turned[1:]).as_rotvec() / dt
    kinetic = 0.5 * ROBOT.mass * np.sum(velocity**2, axis=1)
    rotation = 0.5 * np.sum(ROBOT.principal_inertia * spin**2, axis=1)
    return kinetic + rotation + WEIGHT * path.position[1:, 2]


@pytest.mark.parametrize("dt", [0.0005, 0.005])
def test_a_drop_never_has_more_energy_than_it_began_with(dt):
    start = Start(velocity=(0.4, 0.2, 0.0), height=0.12)
    table = VelocityCoulomb(0.38).table(weight=WEIGHT)
    path = walk(ROBOT, standing(), table, duration=0.6, start=start, options=DynamicsOptions(dt=dt))
    total = energy(path, dt)
    began = 0.5 * ROBOT.mass * 0.2 + WEIGHT * 0.12
    assert total.max() <= began * (1 + 1e-9)
    assert total[-1] == pytest.approx(WEIGHT * 0.07, rel=1e-3)


@pytest.mark.parametrize("dt", [0.0005, 0.005])
def test_a_sliding_stop_only_loses_energy(dt):
    path = walk(
        ROBOT, standing(), COULOMB, duration=0.4, start=Start(velocity=(0.5, 0.1, 0.0)),
        options=DynamicsOptions(dt=dt),
    )  # fmt: skip
    total = energy(path, dt)
    assert np.diff(total).max() < 1e-5 * (total[0] - total[-1])


def test_a_drop_falls_freely_before_it_lands():
    start = Start(height=0.2)
    dt = 0.0002
    path = walk(ROBOT, standing(), SLIP, duration=0.1, start=start, options=DynamicsOptions(dt=dt))
    assert not path.contact.any()
    np.testing.assert_allclose(path.position[:, 2], 0.2 - 0.5 * 9.81 * path.t**2, atol=2e-4)


# --- other ground, other contacts


def test_folded_legs_let_the_body_down_on_its_belly():
    path = walk(ROBOT, standing(-0.5 * np.pi), SLIP, duration=0.5)
    assert path.position[-1, 2] == pytest.approx(0.5 * 0.069, abs=1e-4)
    assert not path.contact.any()


def test_a_belly_slides_to_rest_at_the_distance_friction_says():
    path = walk(
        ROBOT, standing(-0.5 * np.pi), COULOMB, duration=0.5, start=Start(velocity=(0.5, 0.0, 0.0)),
        options=DynamicsOptions(dt=0.0005),
    )  # fmt: skip
    assert path.position[-1, 0] == pytest.approx(0.5**2 / (2 * 0.38 * 9.81), rel=0.02)


@pytest.mark.parametrize("hip_z", [-0.05, 0.02])
def test_a_robot_stands_on_its_legs_wherever_its_hips_are(hip_z):
    robot = replace(ROBOT, hips=ROBOT.hips + np.array([0, 0, hip_z]))
    path = walk(robot, standing(), SLIP, duration=0.1)
    np.testing.assert_allclose(path.position[:, 2], 0.07 - hip_z, atol=1e-4)


def test_a_flat_height_function_is_flat_ground():
    flat = sample_ground(lambda x, y: 0 * x, x=(-0.5, 2.0), y=(-1.0, 1.0))
    on_grid = walk(ROBOT, tripod(), SLIP, duration=2.0, ground=flat)
    np.testing.assert_allclose(
        on_grid.position, walk(ROBOT, tripod(), SLIP, duration=2.0).position, atol=1e-9
    )


def test_a_walk_climbs_a_step_it_can_climb():
    ground = sample_ground(lambda x, y: 0.01 * (x > 0.3), x=(-0.5, 2.0), y=(-1.0, 1.0), step=0.002)
    straight = tripod(STRAIGHT, STRAIGHT)
    path = walk(ROBOT, straight, SLIP, duration=10.0, ground=ground)
    assert path.position[-1, 0] > 0.6
    assert path.position[-100:, 2].mean() - path.position[:100, 2].mean() == pytest.approx(
        0.01, abs=0.003
    )


# --- straight on


def test_a_straight_gait_walks_straight():
    path = walk(ROBOT, tripod(STRAIGHT, STRAIGHT), SLIP, duration=10.0)
    assert abs(path.position[-1, 1]) < 1e-3
    assert path.position[-1, 0] > 0.7


def test_a_leg_offset_is_a_turn_of_that_leg():
    offset = np.zeros(6)
    offset[2] = np.radians(3.0)
    bent = walk(replace(ROBOT, leg_offset=offset), tripod(), SLIP, duration=2.0)
    shifted = SampledReference(tripod().t, tripod().theta + offset)
    same = walk(ROBOT, shifted, SLIP, duration=2.0)
    np.testing.assert_allclose(bent.position, same.position, atol=1e-12)


# --- refused


@pytest.mark.parametrize("options", [{"dt": 0.0}, {"stiffness": -1.0}, {"damping": np.nan}])
def test_a_computation_that_cannot_be_is_refused(options):
    with pytest.raises(DomainError, match="expected more than zero"):
        DynamicsOptions(**options)


def test_a_walk_shorter_than_a_step_is_refused():
    with pytest.raises(DomainError, match=r"0\.0001 s; expected .* one step of 0\.002 s"):
        walk(ROBOT, tripod(), SLIP, duration=0.0001)


def test_a_walk_that_diverges_says_when_and_where():
    gait = tripod()
    theta = gait.theta.copy()
    theta[3] = np.nan
    with pytest.raises(WalkError, match=r"diverged at t = 2.* s, with the body at x .* m"):
        walk(ROBOT, SampledReference(gait.t, theta), SLIP, duration=6.0)


def test_legs_at_no_angle_cannot_be_stood_on():
    with pytest.raises(WalkError, match=r"cannot stand at x 0, y 0 m on legs at \[.*nan"):
        walk(ROBOT, standing(np.nan), SLIP, duration=1.0)


def rough_ground(seed):
    """Return ground of random heights, 5 mm (sd), smooth over some 50 mm."""
    n, step = 160, 0.005
    k = 2 * np.pi * np.fft.fftfreq(n, step)
    smooth = np.exp(-0.25 * 0.05**2 * (k[:, None] ** 2 + k**2))
    white = np.random.default_rng(seed).standard_normal((n, n))
    z = np.fft.ifft2(np.fft.fft2(white) * smooth).real
    z *= 0.005 / z.std()
    return Ground(-0.4, -0.4, step, z, float(z.max()))


@pytest.mark.parametrize("seed", [1, 2])
def test_a_robot_starts_settled_on_rough_ground(seed):
    ground = rough_ground(seed)
    path = walk(ROBOT, standing(), COULOMB, duration=0.2, ground=ground, start=Start(yaw=0.5))
    np.testing.assert_allclose(path.position[0, :2], 0.0, atol=1e-12)
    assert path.yaw[0] == pytest.approx(0.5)
    assert path.normal_force[:5].sum(axis=1).max() < 2 * WEIGHT  # and not thrown up
    assert path.position[:, 2].max() < path.position[0, 2] + 0.001


@pytest.mark.parametrize("seed", [1, 24])  # held in its place, the robot stood on other legs there
def test_a_robot_that_starts_on_rough_ground_does_not_tip_as_it_is_let_go(seed):
    ground = rough_ground(seed)
    legs = np.tile(np.radians([38.0, 118.0, 126.0, 50.0, 38.0, 118.0]), (2, 1))
    sticky = VelocityCoulomb(3.0, 1e-4).table(weight=1.0)
    path = walk(
        ROBOT, SampledReference(np.array([0.0, 1.0]), legs), sticky, duration=0.3, ground=ground
    )
    np.testing.assert_allclose(path.orientation[-1], path.orientation[0], atol=np.radians(0.02))
    np.testing.assert_allclose(path.position[-1, :2], 0.0, atol=2e-5)
