# SPDX-License-Identifier: MIT
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from model.errors import DomainError, WalkError
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import GRAVITY, Robot
from model.slip import MagicFormula
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.ensemble import WalkDraw, planar_walk, walk_ensemble
from model.walk.ground import FLAT, with_slope
from model.walk.traction import law_table

ROBOT = Robot()
SOURCE = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
SLIP = law_table(MagicFormula("peak"), SOURCE, weight=ROBOT.mass * GRAVITY)
OPTIONS = DynamicsOptions(dt=0.005)
TURN = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 2.0)
ROCK = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)


def draws(n=6, *, gait=TURN):
    rng = np.random.default_rng(3)
    return [
        WalkDraw(replace(ROBOT, leg_offset=np.radians(0.5) * rng.standard_normal(6)), gait, SLIP)
        for _ in range(n)
    ]


def test_an_ensemble_is_its_draws_wherever_they_are_walked():
    t = np.linspace(0, 20.0, 41)
    one, two = (
        walk_ensemble(draws(), t, options=OPTIONS, executor=each).poses
        for each in (None, ThreadPoolExecutor(2))
    )
    np.testing.assert_array_equal(one.position, two.position)
    np.testing.assert_array_equal(one.yaw, two.yaw)
    alone = planar_walk(draws()[4], duration=20.0, options=OPTIONS).poses
    np.testing.assert_allclose(
        one.position[4, :, 0], np.interp(t, alone.t, alone.position[:, 0]), atol=1e-12
    )
    assert one.position.shape == (6, 41, 2)


def test_leg_offsets_spread_the_path():
    ensemble = walk_ensemble(draws(12), np.array([0.0, 20.0]), options=OPTIONS).poses
    assert np.all(ensemble.position[:, 0] == 0)
    assert ensemble.position[:, -1].std(axis=0).max() > 0.01


def test_a_log_is_walked_whole_and_like_its_gait():
    t = np.arange(0, 12.0, 0.005)
    log = SampledReference(t, TURN.angles(t))
    times = np.linspace(0, 11.9, 20)
    ensemble = walk_ensemble(
        [WalkDraw(ROBOT, log, SLIP), WalkDraw(ROBOT, TURN, SLIP)], times, options=OPTIONS
    ).poses
    np.testing.assert_allclose(ensemble.position[0], ensemble.position[1], atol=0.003)


def test_rocking_tetrapods_end_after_long_steps_where_they_do_after_short_ones():
    t, rng = np.arange(0.0, 10.01, 0.01), np.random.default_rng(3)
    gait = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=2.0)
    log = SampledReference(t, gait.angles(t))
    legs = np.radians(1.0) * rng.standard_normal((32, 6))
    several = [WalkDraw(replace(ROBOT, leg_offset=offset), log, SLIP) for offset in legs]
    long, short = (
        walk_ensemble(several, t[::10], options=DynamicsOptions(dt=dt)).poses.position
        for dt in (0.005, 0.00025)
    )
    length = np.linalg.norm(np.diff(short, axis=1), axis=2).sum(axis=1).mean()
    assert np.linalg.norm((long - short)[:, -1].mean(axis=0)) < 0.003 * length


def test_progress_is_told_to_the_end():
    told = []
    walk_ensemble(draws(3), np.array([0.0, 1.0]), options=OPTIONS, progress=told.append)
    assert told == pytest.approx([1 / 3, 2 / 3, 1.0])


def test_a_draw_that_diverges_says_which_and_when():
    t = np.linspace(0, 4.0, 401)
    theta = TURN.angles(t)
    theta[200] = np.nan
    broken = SampledReference(t, theta)
    three = [*draws(2), WalkDraw(ROBOT, broken, SLIP)]
    with pytest.raises(WalkError, match=r"draw 3 of 3: the walk diverged at t = 1\.9.* s, with"):
        walk_ensemble(three, np.array([0.0, 4.0]), options=OPTIONS)


def test_an_ensemble_of_nothing_is_refused():
    with pytest.raises(DomainError, match="expected at least one"):
        walk_ensemble([], np.array([0.0, 1.0]))


@pytest.mark.parametrize("t", [[], [0.0, 0.0], [1.0, 0.5], [-1.0, 1.0], [0.0, np.nan]])
def test_times_that_do_not_increase_are_refused(t):
    with pytest.raises(DomainError, match="expected one or more that increase"):
        walk_ensemble(draws(1), np.array(t))


# --- strides of a constant gait


@pytest.mark.parametrize(("gait", "duration"), [(TURN, 31.0), (ROCK, 40.0)])
def test_repeated_strides_end_where_every_step_does(gait, duration):
    path = walk(ROBOT, gait, SLIP, duration=duration, options=OPTIONS)
    found = planar_walk(WalkDraw(ROBOT, gait, SLIP), duration=duration, options=OPTIONS)
    np.testing.assert_allclose(found.poses.t, path.t, atol=1e-9)
    distance = np.linalg.norm(found.poses.position - path.position[:, :2], axis=1)
    assert distance.max() < 0.002 * path.length
    assert np.abs(found.poses.yaw - path.yaw).max() < np.radians(0.5)


def test_strides_are_as_long_as_whole_steps_that_fit_the_period():
    odd = tripod_reference(tripod_angles(np.radians(50.0), 1.3), 1.0037)
    t = planar_walk(WalkDraw(ROBOT, odd, SLIP), duration=3.0, options=OPTIONS).poses.t
    steps = odd.period / np.diff(t)
    np.testing.assert_allclose(steps, round(steps[0]), rtol=1e-9)
    assert np.diff(t)[0] <= OPTIONS.dt


@pytest.mark.parametrize("duration", [0.0, -1.0, np.nan, np.inf])
def test_a_walk_of_no_time_is_refused(duration):
    with pytest.raises(DomainError, match="duration"):
        planar_walk(draws(1)[0], duration=duration, options=OPTIONS)


# --- other ground


def test_on_a_slope_every_step_of_a_draw_is_walked():
    uphill = with_slope(FLAT, np.radians(5.0), 0.0)
    draw = WalkDraw(ROBOT, TURN, SLIP, ground=uphill)
    found = planar_walk(draw, duration=4.5, options=OPTIONS).poses
    path = walk(ROBOT, TURN, SLIP, duration=4.5, ground=uphill, options=OPTIONS)
    np.testing.assert_allclose(found.position, path.position[:, :2], atol=1e-12)
    np.testing.assert_allclose(found.yaw, path.yaw, atol=1e-12)
