# SPDX-License-Identifier: MIT
"""Figures over time show where the robot walks, or the window that was asked for."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.walk.path import WalkPath
from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.picture_options import Window
from zebro_lab.walk.shown_time import last_cycles, leg_turns, part_in, require_shown_times

CYCLE = 1.6


def path_of(turned, t, *, spin=False) -> WalkPath:
    """Return a path whose legs have turned so far [turns]; on a spin the left ones backwards."""
    n = len(t)
    sides = np.array([-1.0, 1.0] * 3) if spin else np.ones(6)
    return WalkPath(
        t, np.zeros((n, 3)), np.zeros((n, 3)), 2 * np.pi * turned[:, None] * sides,
        np.ones((n, 6), dtype=bool), np.zeros((n, 6, 2)), np.zeros((n, 6)), np.ones((n, 6)),
        np.zeros((n, 6, 2)),
    )  # fmt: skip


def walk(stood, walking, stands, *, spin=False, noise=0.0) -> WalkPath:
    t = np.arange(0, stood + walking + stands, 0.01)
    turned = np.clip(t - stood, 0, walking) / CYCLE
    turned += noise * np.random.default_rng(1).normal(size=len(t))
    return path_of(turned, t, spin=spin)


@pytest.mark.parametrize("spin", [False, True])
@given(stood=st.floats(0, 5), walking=st.floats(4, 20), stands=st.floats(0.2, 30))
def test_the_last_two_cycles_of_walking_are_shown_not_the_end_of_the_log(
    spin, stood, walking, stands
):
    shown = last_cycles(walk(stood, walking, stands, spin=spin)).t
    assert shown[0] == pytest.approx(stood + walking - 2 * CYCLE, abs=0.03)
    assert shown[-1] == pytest.approx(stood + walking + 0.1, abs=0.05)


def test_a_walk_that_ends_walking_is_shown_to_its_end():
    path = walk(1.0, 10.0, 0.0)
    assert last_cycles(path).t[-1] == path.t[-1]


def test_noise_of_encoders_at_rest_is_no_walking():
    shown = last_cycles(walk(2.0, 8.0, 20.0, noise=1e-4)).t
    assert shown[-1] == pytest.approx(10.1, abs=0.1)
    assert shown[0] == pytest.approx(10.0 - 2 * CYCLE, abs=0.1)


def test_a_walk_of_less_than_two_cycles_is_shown_from_its_first_step():
    shown = last_cycles(walk(5.0, 2.0, 10.0)).t
    assert shown[0] == pytest.approx(5.0, abs=0.05)


@pytest.mark.parametrize("n", [2, 50])
def test_a_robot_that_stands_is_shown_whole(n):
    path = path_of(np.zeros(n), np.arange(n) * 0.01)
    assert len(last_cycles(path).t) == n


def test_turns_of_legs_that_all_turn_forwards_are_those_of_their_mean(walked):
    mean = walked.theta.mean(axis=1)
    expected = (np.maximum.accumulate(mean) - mean[0]) / (2 * np.pi)
    np.testing.assert_allclose(leg_turns(walked), expected, atol=1e-12)
    backwards = replace(walked, theta=-walked.theta)
    np.testing.assert_allclose(leg_turns(backwards), leg_turns(walked), atol=1e-12)


def test_a_window_cuts_the_walk_and_must_lie_in_it(walked):
    assert part_in(walked, None).t[-1] == last_cycles(walked).t[-1]
    shown = part_in(walked, Window(1.0, 1.5)).t
    assert (shown[0], shown[-1]) == pytest.approx((1.0, 1.5))
    with pytest.raises(SettingsError, match=r"--window.*90:91 s.*lasts from 0 to"):
        part_in(walked, Window(90.0, 91.0))


@pytest.mark.parametrize(
    ("at", "window", "fault"),
    [((1.0, 9.5), None, r"--at.*9\.5 s.*2 to 8 s"), ((), Window(8.0, 9.0), r"--window.*8:9 s")],
)
def test_times_outside_the_walk_are_refused_before_it_is_computed(at, window, fault):
    require_shown_times((2.0, 8.0), Window(0.0, 3.0), 2.0, 8.0)
    with pytest.raises(SettingsError, match=fault):
        require_shown_times(tuple(t for t in at if t > 1) or at, window, 2.0, 8.0)
