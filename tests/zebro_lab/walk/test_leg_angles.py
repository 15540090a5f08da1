# SPDX-License-Identifier: MIT
"""Counts of an encoder are recognised, and other angles are taken as they are."""

import numpy as np
import pytest

from model.gait.buehler import buehler_reference
from model.gait.inexact_log import InexactLog
from model.gait.reference import SampledReference
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.walk.leg_angles import angles_from


def leg_log(theta: np.ndarray) -> LegLog:
    return LegLog(SampledReference(5.0 + 0.01 * np.arange(len(theta)), theta), "real", ())


def test_counted_angles_are_recognised_and_others_taken_as_they_are():
    theta = np.linspace(0.0, 2.8, 400)[:, None] ** 2 + np.arange(6)
    legs, notes = angles_from(leg_log(theta), 5.0)
    assert isinstance(legs, SampledReference)
    np.testing.assert_array_equal(legs.theta, theta)
    assert legs.t[0] == 0.0
    assert notes == ()
    step = np.radians(3.6)
    counted, notes = angles_from(leg_log(step * np.round(theta / step)), 5.0)
    assert isinstance(counted, InexactLog)
    assert counted.step == pytest.approx(step)
    assert counted.t[0] == 0.0
    assert "counted in steps of 3.6 deg" in notes[0]


def test_coarse_angles_are_taken_as_they_are_with_a_note():
    gait = buehler_reference(-0.6, 0.7, ground_time=0.51, cycle_time=1.0)
    t = np.arange(0.0, 12.0, 0.2)
    coarse = gait.angles(t)
    legs, notes = angles_from(LegLog(SampledReference(t, coarse), "real", ()), 0.0)
    assert isinstance(legs, SampledReference)
    np.testing.assert_array_equal(legs.theta, coarse)
    assert "too much between samples" in notes[0]


def test_noise_is_said_and_reconstructed_and_legs_that_turn_unevenly_are_named():
    t = 0.01 * np.arange(900)
    theta = 1.3 * t[:, None] + np.zeros(6)
    noise = np.random.default_rng(0).normal(0.0, 5e-4, theta.shape)
    legs, notes = angles_from(leg_log(theta + noise), 5.0)
    assert isinstance(legs, InexactLog)
    np.testing.assert_allclose(legs.noise, 5e-4, rtol=0.3)
    assert np.abs(legs.smooth().angles(t) - theta).max() < 1.5e-4
    assert "noise of 0.029 deg (0.51 mrad)" in notes[0]
    uneven = np.pi * t[:, None] + 0.8 * np.sin(np.pi * t[:, None]) * (np.arange(6) < 2)
    _, notes = angles_from(leg_log(uneven + 2 * noise), 5.0)
    assert "2 of 6 legs turn unevenly" in notes[0]


def test_counts_of_noisy_angles_are_told_from_counts_alone():
    t = 0.01 * np.arange(900)
    theta = 1.3 * t[:, None] + np.arange(6) ** 1.3
    step = np.radians(0.35)
    for share, words in (
        (0.0, "0.35 deg, reconstructed"),
        (0.3, "by more than counting: noise of 0.1"),
    ):
        noise = np.random.default_rng(0).normal(0.0, share * step, theta.shape)
        legs, notes = angles_from(leg_log(step * np.round((theta + noise) / step)), 5.0)
        assert isinstance(legs, InexactLog)
        assert words in notes[0]
        assert np.abs(legs.smooth().angles(t) - theta).max() < 0.3 * step
