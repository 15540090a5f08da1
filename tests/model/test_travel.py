# SPDX-License-Identifier: MIT
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.poses import Poses, wrap
from model.travel import (
    has_travelled,
    path_length,
    position_noise,
    travel_chord,
    travel_direction,
    travel_turn,
    travelled,
    turn_oppositely,
)

RADIUS, SPEED, DURATION, REST = 1.2, 0.09, 22.0, 3.0  # m, m/s, s, s at either end


def way(t):
    """Distance along the walk: it stands, walks and stands again [m]."""
    return SPEED * np.clip(t - REST, 0, DURATION - 2 * REST)


def arc(rate, noise, *, seed=1):
    """A walk on a circle to the left at `rate` [Hz], with `noise` [m] on x and on y."""
    t = np.arange(0, DURATION + 1e-9, 1 / rate)
    turned = way(t) / RADIUS
    xy = RADIUS * np.column_stack([np.sin(turned), 1 - np.cos(turned)])
    return Poses(t, xy + np.random.default_rng(seed).normal(0, noise, xy.shape), turned)


@pytest.mark.parametrize("rate", [3, 10, 30, 120, 240])
@pytest.mark.parametrize("noise", [0, 1e-4, 3e-4, 1e-3, 2e-3])
def test_a_path_has_one_length_at_every_rate_and_noise(rate, noise):
    assert path_length(arc(rate, noise)) == pytest.approx(way(DURATION), rel=0.01)


@pytest.mark.parametrize("rate", [3, 240])
@pytest.mark.parametrize("noise", [1e-4, 2e-3])
def test_the_noise_is_found_in_the_path_itself(rate, noise):
    assert position_noise(arc(rate, noise)) == pytest.approx(noise, rel=0.3)


def test_a_smooth_path_at_uneven_times_has_no_noise():
    t = np.sort(np.random.default_rng(1).uniform(0, 20, 40))
    assert position_noise(Poses(t, np.column_stack([0.1 * t, 0.01 * t**2]), 0 * t)) < 1e-9
    assert position_noise(arc(2, 0.01).part(slice(4))) == 0


@pytest.mark.parametrize("noise", [3e-4, 2e-3])
def test_the_distance_travelled_and_its_direction_follow_the_walk_also_where_it_stands(noise):
    poses = arc(120, noise)
    found = travelled(poses)
    assert np.all(np.diff(found) >= 0)
    np.testing.assert_allclose(found, way(poses.t), atol=8 * noise)
    off = np.abs(wrap(travel_direction(poses) - poses.yaw))
    assert np.degrees(off.max()) < 12
    assert np.degrees(np.median(off)) < 3


def test_noise_that_hangs_together_in_time_is_not_travelled():
    t = np.arange(0, 10, 1 / 120)
    wobble = 5e-4 * np.column_stack([np.sin(9 * t), np.cos(7 * t)])
    stood = np.column_stack([0.1 * np.clip(t - 5, 0, None), 0 * t]) + wobble
    assert path_length(Poses(t, stood, 0 * t)) == pytest.approx(0.5, rel=0.01)


@given(seed=st.integers(0, 1000))
def test_poses_farther_apart_than_the_chord_all_count(seed):
    rng = np.random.default_rng(seed)
    steps = 0.2 * np.exp(1j * np.cumsum(rng.uniform(-0.3, 0.3, 12)))
    places = np.concatenate([[0], np.cumsum(steps)])
    t = np.cumsum(rng.uniform(1.0, 3.0, 13))
    poses = Poses(t, np.column_stack([places.real, places.imag]), 0 * t)
    np.testing.assert_allclose(travelled(poses, chord=0.1), 0.2 * np.arange(13))


@pytest.mark.parametrize("noise", [0, 1e-3])
@pytest.mark.parametrize("turns", [0.5, 1, 1.4, 2, 4.2])
@pytest.mark.parametrize("poses_a_turn", [5, 6, 6.7, 8, 10, 12])
def test_all_poses_of_a_sparse_circle_count(poses_a_turn, turns, noise):
    angle = 2 * np.pi * np.arange(int(poses_a_turn * turns) + 1) / poses_a_turn
    places = 0.15 * np.column_stack([np.sin(angle), 1 - np.cos(angle)])
    places += np.random.default_rng(4).normal(0, noise, places.shape)
    poses = Poses(1.5 * angle, places, angle)
    lines = np.linalg.norm(np.diff(places, axis=0), axis=1)
    np.testing.assert_allclose(travelled(poses), np.concatenate([[0], np.cumsum(lines)]))
    off = np.abs(wrap(travel_direction(poses) - angle))[1:-1]
    assert np.degrees(off.max()) < 3
    assert travel_turn(poses) == pytest.approx(angle[-1] - angle[1], rel=0.05)


def test_one_chord_makes_lengths_of_two_paths_comparable():
    noisy, smooth = arc(120, 2e-3), arc(120, 0)
    chord = travel_chord(noisy)
    assert path_length(smooth, chord=chord) == pytest.approx(
        path_length(noisy, chord=chord), rel=0.01
    )
    assert chord > travel_chord(smooth)


def test_a_way_out_and_back_is_travelled_twice():
    t = np.linspace(0, 10, 601)
    poses = Poses(t, np.column_stack([1 - np.abs(1 - t / 5), 0 * t]), 0 * t)
    assert path_length(poses) == pytest.approx(2.0, rel=0.02)
    assert travel_direction(poses)[[1, -2]] == pytest.approx([0, np.pi])


def test_travel_direction_follows_the_line_and_stands_with_the_robot():
    t = np.array([0.0, 1.0, 2.0, 4.0])
    still = Poses(t, np.array([[0.0, 0], [0, 1], [0, 1], [0, 1]]), np.zeros(4))
    np.testing.assert_allclose(travel_direction(still), np.pi / 2)
    assert path_length(still) == 1
    line = Poses(t, np.column_stack([0.5 * t, 0.0 * t]), 0.1 * t)
    np.testing.assert_array_equal(travel_direction(line), 0.0)


@pytest.mark.parametrize("n", [0, 1, 2, 6])
def test_what_never_moves_has_neither_length_nor_direction(n):
    poses = Poses(np.arange(n) + 0.0, np.ones((n, 2)), np.zeros(n))
    assert path_length(poses) == 0
    np.testing.assert_array_equal(travelled(poses), np.zeros(n))
    np.testing.assert_array_equal(travel_direction(poses), np.zeros(n))
    assert not has_travelled(poses)


def test_a_robot_that_stands_in_noise_has_not_travelled():
    places = np.random.default_rng(1).normal(0, 0.002, (500, 2))
    assert not has_travelled(Poses(np.arange(500) / 120, places, np.zeros(500)))
    assert has_travelled(arc(120, 0.002))


def mirrored(poses):
    return Poses(poses.t, poses.position * [1, -1], -poses.yaw)


@pytest.mark.parametrize("rate", [2, 120])
@pytest.mark.parametrize("noise", [0, 2e-3])
def test_a_mirror_image_turns_to_the_other_side(rate, noise):
    seen = arc(rate, noise, seed=2)
    assert travel_turn(seen) == pytest.approx(way(DURATION) / RADIUS, rel=0.15)
    assert turn_oppositely(arc(30, 0), mirrored(seen))
    assert not turn_oppositely(arc(30, 0), seen)


def test_what_turns_little_or_by_another_curvature_is_no_mirror_image():
    short = arc(30, 0).part(slice(200))
    assert not turn_oppositely(short, mirrored(short))
    t = np.linspace(0, 10, 200)
    tight = Poses(t, 0.2 * np.column_stack([np.sin(t / 5), np.cos(t / 5)]), -t / 5)
    assert not turn_oppositely(arc(30, 0), tight)


def test_a_reversal_is_no_turn():
    t = np.linspace(0, 10, 601)
    place = 1 - np.abs(1 - t / 5)
    noise = np.random.default_rng(1).normal(0, 1e-3, (601, 2))
    assert abs(travel_turn(Poses(t, np.column_stack([place, 0 * t]) + noise, 0 * t))) < 0.4
