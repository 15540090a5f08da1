# SPDX-License-Identifier: MIT
import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.errors import DomainError
from model.gait.buehler import buehler_reference
from model.gait.inexact_log import InexactLog
from model.gait.lines import FASTEST

STEP = np.radians(3.6)
T = np.arange(0, 6, 0.01)
EVERYWHERE = np.arange(0, T[-1], 1e-4)


def tripod(t, *, cycle=2.0, slow=1.2, stood=0.0):
    """Angles of six legs that sweep slowly for half a cycle and fast for the other half."""
    phase = (np.maximum(t[:, None] - stood, 0.0) + cycle * np.arange(6) / 6) / cycle
    turns, inside = np.floor(phase), phase % 1
    fast = 2 * np.pi - slow
    sweep = np.where(inside < 0.5, 2 * slow * inside, slow + 2 * fast * (inside - 0.5))
    return 0.9 + 2 * np.pi * turns + sweep


def counted(theta):
    return STEP * np.round(theta / STEP)


def within(gait, began):
    """Return a gait's log from a time on, and times and true angles half a cycle from its ends."""
    half = 0.5 * gait.period
    fine = EVERYWHERE[(half < EVERYWHERE) & (half < EVERYWHERE[-1] - EVERYWHERE)]
    return InexactLog(T, counted(gait.angles(T + began)), STEP), fine, gait.angles(fine + began)


def errors(motion, fine, truth):
    """Return the largest error of six legs at each time, in counts."""
    return np.abs(motion.angles(fine) - truth).max(axis=1) / STEP


@settings(max_examples=30)
@given(
    cycle=st.floats(1.5, 4.0), ground=st.floats(0.4, 0.6), touchdown=st.floats(-1.1, -0.4),
    liftoff=st.floats(0.4, 1.1), began=st.floats(0.0, 4.0), seed=st.integers(0, 9),
)  # fmt: skip
def test_no_angle_between_samples_is_a_count_off(cycle, ground, touchdown, liftoff, began, seed):
    gait = buehler_reference(touchdown, liftoff, ground_time=ground * cycle, cycle_time=cycle)
    log, fine, truth = within(gait, began)
    assert errors(log.smooth(), fine, truth).max() < 1
    drawn = log.smooth(np.random.default_rng(seed))
    assert errors(drawn, fine[::10], truth[::10]).max() < 1


@given(seed=st.integers(0, 1000))
def test_legs_that_change_speed_all_the_time_never_jump(seed):
    rng = np.random.default_rng(seed)
    corners = np.arange(0, 6.01, 0.05)
    speeds = rng.uniform(0, 6, (6, len(corners)))
    theta = np.column_stack([np.interp(T, corners, 0.05 * np.cumsum(each)) for each in speeds])
    log = InexactLog(T, counted(theta), STEP)
    for motion in (log.smooth(), log.smooth(rng)):
        assert np.diff(motion.t).min() > 0.9e-6
        assert np.abs(motion.speeds(motion.t)).max() < 1.01 * FASTEST


def coverage(step_deg, rate, *, draws=99):
    """Return the shares of angles within the central 50 and 90 % of draws, of many gaits."""
    step, rng = np.radians(step_deg), np.random.default_rng(8)
    within = []
    for _ in range(8):
        cycle, began = rng.uniform(1.3, 3.0), rng.uniform(0.0, 3.0)
        gait = buehler_reference(
            *rng.uniform((-1.0, 0.5), (-0.5, 1.0)), ground_time=0.52 * cycle, cycle_time=cycle
        )
        t, fine = np.arange(0, 6, 1 / rate), rng.uniform(0.5, 5.5, 200)
        log = InexactLog(t, step * np.round(gait.angles(t + began) / step), step)
        truth = gait.angles(fine + began)
        below = sum(log.smooth(rng).angles(fine) < truth for _ in range(draws))
        within.append(np.abs(2 * (below + 0.5) / (draws + 1) - 1))
    return [float(np.mean(np.concatenate(within) < share)) for share in (0.5, 0.9)]


@pytest.mark.parametrize(("step_deg", "rate"), [(3.6, 50.0), (2.0, 20.0), (1.0, 50.0)])
def test_draws_cover_the_angle_as_often_as_they_say(step_deg, rate):
    half, most = coverage(step_deg, rate)
    assert 0.45 < half < 0.8
    assert 0.87 < most <= 1.0


@given(cycle=st.floats(1.2, 3.0), began=st.floats(0.0, 3.0), rate=st.sampled_from([20.0, 50.0]))
def test_fine_counts_at_low_rates_keep_fast_corners(cycle, began, rate):
    step = np.radians(0.2)
    gait = buehler_reference(-0.6, 0.7, ground_time=0.5 * cycle, cycle_time=cycle)
    t, fine = np.arange(0, 6, 1 / rate), np.arange(0.7 * cycle, 6 - 0.7 * cycle, 1e-3)
    log = InexactLog(t, step * np.round(gait.angles(t + began) / step), step)
    error = log.smooth().angles(fine) - gait.angles(fine + began)
    assert np.abs(error).max() < 0.1 * np.radians(0.2) * 360 / rate  # at most 2 % of a swing's step


@settings(max_examples=30)
@given(seed=st.integers(0, 1000), step_deg=st.floats(0.1, 5.0))
def test_no_sample_is_missed_by_more_than_its_count(seed, step_deg):
    rng, step = np.random.default_rng(seed), np.radians(step_deg)
    speeds = rng.uniform(0, 6, (6, 20))
    theta = np.cumsum(0.02 * np.repeat(speeds, 10, axis=1), axis=1).T
    t = 0.02 * np.arange(len(theta))
    log = InexactLog(t, step * np.round(theta / step), step)
    for motion in (log.smooth(), log.smooth(rng)):
        assert np.abs(motion.angles(t) - log.theta).max() < 0.6 * step


def test_lines_whose_samples_repeat_are_drawn_alike():
    t = np.arange(0, 9.99, 0.01)  # cycles of 200 samples
    log = InexactLog(t, counted(tripod(t)), STEP)
    off = log.smooth(np.random.default_rng(3)).angles(t) - log.smooth().angles(t)
    assert np.abs(off[250:450] - off[450:650]).max() < 1e-6
    assert np.abs(off[250:450]).max() > 1e-3


def test_a_leg_that_never_moves_stays_in_its_count():
    t = np.arange(0, 2, 0.01)
    still = np.zeros((len(t), 6))
    log = InexactLog(t, still, STEP)
    np.testing.assert_array_equal(log.smooth().angles(t), 0)
    drawn = log.smooth(np.random.default_rng(1)).angles(t)
    assert np.all(np.abs(drawn) <= 0.5 * STEP)
    assert np.all(np.ptp(drawn, axis=0) == 0)


def test_a_pause_in_the_middle_stays_a_pause():
    t = np.arange(0, 9, 0.01)
    walked = np.where(t < 4.03, t, np.maximum(4.03, t - 1.5))
    theta = tripod(walked)
    smooth = InexactLog(t, counted(theta), STEP).smooth().angles(t)
    assert np.abs(smooth - theta).max() < 1.0 * STEP


@pytest.mark.parametrize("sd", [1e-4, 5e-4, 2e-3])
@pytest.mark.parametrize("rate", [50, 100])
def test_noise_leaves_speeds_and_corners_and_draws_hold_the_angles(sd, rate):
    rng = np.random.default_rng(5)
    t = np.arange(0, 10, 1 / rate)
    t = np.delete(t, slice(3 * rate, 3 * rate + 5))
    theta = tripod(t)
    log = InexactLog(t, theta + rng.normal(0, sd, theta.shape), 0.0, np.full(6, sd))
    assert np.abs(log.smooth().angles(t) - theta).max() < 2 * sd
    assert np.sqrt(np.mean((log.smooth().angles(t) - theta) ** 2)) < 0.4 * sd
    draws = np.stack([log.smooth(rng).angles(t) for _ in range(60)])
    low, high = np.quantile(draws, [0.05, 0.95], axis=0)
    assert np.mean((low <= theta) & (theta <= high)) > 0.8


@pytest.mark.parametrize("sd", [2e-4, 1e-3, 1e-2])
def test_noisy_legs_that_turn_unevenly_are_smoothed_and_others_are_not(sd):
    rng = np.random.default_rng(5)
    t = np.arange(0, 10, 0.01)
    theta = tripod(t)
    theta[:, ::2] = np.pi * t[:, None] + 0.8 * np.sin(np.pi * t[:, None])
    log = InexactLog(t, theta + rng.normal(0, sd, theta.shape), 0.0, np.full(6, sd))
    assert log.uneven == 3
    assert np.sqrt(np.mean((log.smooth().angles(t) - theta) ** 2, axis=0)).max() < 0.6 * sd
    draws = np.stack([log.smooth(rng).angles(t) for _ in range(60)])
    low, high = np.quantile(draws, [0.05, 0.95], axis=0)
    assert np.mean((low <= theta) & (theta <= high), axis=0).min() > 0.8


def test_noise_is_of_six_legs_and_more_than_nothing():
    for noise in (np.zeros(6), np.full(5, 1e-3), np.full(6, np.nan)):
        with pytest.raises(DomainError, match="six of more than zero"):
            InexactLog(T, np.zeros((len(T), 6)), 0.0, noise)


def test_a_count_of_nothing_is_refused():
    with pytest.raises(DomainError, match="more than zero"):
        InexactLog(np.arange(3.0), np.zeros((3, 6)), 0.0)


def test_times_that_do_not_increase_are_refused():
    with pytest.raises(DomainError, match="expected increasing times"):
        InexactLog(np.array([0.0, 2.0, 1.0]), np.zeros((3, 6)), STEP)


@pytest.mark.reference
def test_counted_angles_of_an_engine_s_servos_come_back(shared):
    table = pd.read_csv(shared / "virtual-world/walks/tripod_s1.20_left_mu0.38_tc2.csv.gz")
    theta = table[[f"th{leg}" for leg in range(1, 7)]].to_numpy()
    t = table["t"].to_numpy()
    smooth = InexactLog(t, counted(theta), STEP).smooth().angles(t)
    assert np.degrees(np.sqrt(np.mean((smooth - theta) ** 2))) < 0.15
