# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.metrics.turning import fitted_radius, mean_yaw_rate
from model.poses import Poses


def circle(radius, *, turn=4.0, crab=0.0, n=30):
    """Return poses on a circle, counter-clockwise for a positive radius."""
    yaw = np.sign(radius) * np.linspace(0.0, turn, n)
    position = radius * np.column_stack([np.sin(yaw), -np.cos(yaw)])
    return Poses(np.linspace(0.0, 2.0, n), position, yaw + crab)


@pytest.mark.parametrize("radius", [0.5, -0.5])
@pytest.mark.parametrize("crab", [0.0, 0.3])
def test_a_circle_s_radius_comes_back_with_its_side(radius, crab):
    assert fitted_radius(circle(radius, crab=crab)) == pytest.approx(radius)


def test_what_hardly_turns_is_straight():
    assert fitted_radius(circle(20.0, turn=0.05)) == np.inf


def path_of(yaw):
    """Return a path of even steps along the headings."""
    steps = 0.02 * np.column_stack([np.cos(yaw), np.sin(yaw)])
    return Poses(0.1 * np.arange(len(yaw)), np.cumsum(steps, axis=0), yaw)


@pytest.mark.parametrize(
    "yaw",
    [
        np.radians(40) * np.sin(np.linspace(0, 2 * np.pi, 200)),
        np.concatenate([np.linspace(0, 1.5, 100), np.linspace(1.5, 0, 100)]),
        np.concatenate([np.zeros(120), np.linspace(0, 1.5, 60), np.full(120, 1.5)]),
        np.radians(4) * np.random.default_rng(1).normal(size=200),
    ],
    ids=["wave", "S-curve", "bend between straights", "straight with noise"],
)
def test_what_is_no_circle_has_no_radius(yaw):
    assert np.isnan(fitted_radius(path_of(yaw)))


@pytest.mark.parametrize("turn", [0.1, 0.5, 2.0, 7.0])
def test_an_arc_that_sways_keeps_its_radius(turn):
    poses = circle(1.5, turn=turn, n=120)
    sway = 0.004 * np.sin(np.arange(120.0))
    swaying = Poses(poses.t, poses.position + sway[:, None], poses.yaw + sway)
    assert fitted_radius(swaying) == pytest.approx(1.5, rel=0.2)


def test_headings_are_needed():
    poses = circle(0.5)
    blind = Poses(poses.t, poses.position, np.full(len(poses), np.nan))
    assert np.isnan(fitted_radius(blind))
    assert np.isnan(mean_yaw_rate(blind))


def test_the_yaw_rate_is_the_slope_of_the_heading():
    assert mean_yaw_rate(circle(0.5)) == pytest.approx(2.0)
    assert mean_yaw_rate(circle(-0.5)) == pytest.approx(-2.0)


@pytest.mark.parametrize("yaw", [0.0, 0.1, -2.0])
def test_the_yaw_rate_of_a_path_that_stands_still_is_exactly_zero(yaw):
    t = np.linspace(0.1, 3.7, 37)
    still = Poses(t, np.zeros((37, 2)), np.nextafter(np.full(37, yaw), np.tile([9.0], 37)))
    rounded = Poses(t, still.position, yaw + np.spacing(yaw) * (np.arange(37) % 3))
    assert (mean_yaw_rate(still), mean_yaw_rate(rounded)) == (0.0, 0.0)
