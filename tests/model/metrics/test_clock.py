# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.errors import InsufficientData
from model.metrics.clock import estimate_offset
from model.poses import Poses


def walk(*, standing=2.0, speed=0.1, radius=1.5, duration=24.0):
    """Stand, walk a circle, stand; bounce along it as a robot does with every step."""
    t = np.arange(0.0, duration, 0.01)
    gone = speed * np.clip(t - standing, 0.0, duration - 2 * standing)
    yaw = gone / radius
    return Poses(t, radius * np.column_stack([np.sin(yaw), 1 - np.cos(yaw)]), yaw)


def tracked(path, offset, rng, *, sd=0.002, every=2.0):
    """Look at a path every two seconds from another frame, by a clock that is `offset` behind."""
    seen = path.at(np.arange(path.t[0] + 0.3, path.t[-1] - 0.1, every))
    moved = seen.moved(rotation=0.8, translation=[2.0, -1.0])
    noise = rng.normal(0, sd, moved.position.shape)
    return Poses(moved.t - offset, moved.position + noise, moved.yaw)


def test_the_offset_of_another_clock_is_found_within_what_is_said_of_it():
    path, errors, told = walk(), [], []
    for seed in range(12):
        found = estimate_offset(tracked(path, 987.65, np.random.default_rng(seed)), path)
        errors.append(found.value - 987.65)
        told.append(found.sd)
    assert np.abs(errors).max() < 0.2
    assert np.mean(np.abs(errors) < 2 * np.array(told)) >= 0.8
    assert np.mean(told) < 3 * np.std(errors)  # and no more is said than need be


def test_a_wrong_speed_is_not_taken_for_a_wrong_clock():
    for speed in (0.095, 0.105):
        found = estimate_offset(
            tracked(walk(speed=speed), 5.0, np.random.default_rng(3)), walk(speed=0.1)
        )
        assert abs(found.value - 5.0) < 0.15


def test_an_even_walk_without_start_and_stop_tells_nothing():
    path = walk(standing=0.0)
    inner = path.part((path.t > 4) & (path.t < 20))
    with pytest.raises(InsufficientData, match="offset"):
        estimate_offset(tracked(inner, 3.0, np.random.default_rng(1)), path)


def test_too_few_poses_are_refused():
    path = walk()
    few = tracked(path, 0.0, np.random.default_rng(1), every=6.0)
    with pytest.raises(InsufficientData, match="6 are needed"):
        estimate_offset(few, path)


def test_a_gait_that_rocks_as_photographs_come_again_is_not_told_by_its_rocking():
    path = walk(standing=0.0)
    rocking = np.column_stack([0.0 * path.t, 0.01 * np.sin(2 * np.pi * path.t / 3.0)])
    path = Poses(path.t, path.position + rocking, path.yaw)
    inner = path.part((path.t > 3) & (path.t < 21))
    with pytest.raises(InsufficientData, match="about as well"):
        estimate_offset(tracked(inner, 3.0, np.random.default_rng(1)), path)
