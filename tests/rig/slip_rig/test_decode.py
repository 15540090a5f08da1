# SPDX-License-Identifier: MIT
"""Zeros of a load cell, and their drift."""

import numpy as np
import pytest

from rig.device import Sample
from rig.errors import ProtocolError
from rig.slip_rig.decode import (
    Forces,
    Zero,
    decode_disc_angles,
    decode_forces,
    decode_speeds,
    disc_speed,
    tare,
    zero_change,
)
from rig.slip_rig.profile import load_rig_profile

RIG = load_rig_profile("rig-odrive-netft")
PROFILE = RIG.load_cell


def forces(normal, traction, n=1000, sd=0.01, seed=0):
    noise = np.random.default_rng(seed).normal(0, sd, (2, n))
    return Forces(np.arange(n) / 1000.0, normal + noise[0], traction + noise[1])


def test_a_tare_finds_the_zero_within_its_own_error():
    zero = tare(forces(0.3, -0.1))
    assert abs(zero.normal - 0.3) < 5 * zero.standard_error
    assert abs(zero.traction + 0.1) < 5 * zero.standard_error
    assert zero.standard_error == pytest.approx(0.01 / np.sqrt(1000), rel=0.6)


def test_a_zero_that_moved_is_told_and_one_that_stayed_is_not():
    before, after = tare(forces(0.0, 0.0)), tare(forces(0.0, 0.2, seed=1))
    assert not zero_change(before, tare(forces(0.0, 0.0, seed=2)), limit=0.05)
    assert "traction force's zero has moved by 0.2" in zero_change(before, after, limit=0.05)
    assert not zero_change(Zero(0, 0, 0.1), Zero(0.2, 0, 0.1), limit=0.05)


def test_too_few_readings_are_no_zero():
    with pytest.raises(ProtocolError, match="at least 10"):
        tare(decode_forces(PROFILE, [Sample(0.0, 0.0, 0, (0,) * 6)] * 9))


def drive_sample(time, drive, motor_speed):
    return Sample(time, None, None, (0.0, motor_speed), channel=drive.node)


def test_the_ground_disc_is_interpolated_to_the_instants_of_the_leg_disc():
    leg, ground = RIG.drives.leg, RIG.drives.ground
    ramp = [drive_sample(t, ground, 3.0 * t) for t in (0.5, 1.5, 2.5)]
    steady = [drive_sample(t, leg, 2.0) for t in (0.0, 1.0, 2.0, 3.0)]
    speeds = decode_speeds(leg, ground, sorted(ramp + steady, key=lambda each: each.host_time))
    np.testing.assert_allclose(speeds.time, [0.0, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(speeds.leg, disc_speed(leg, 2.0))
    held_before, held_after = 1.5, 7.5  # motor's speed at the first and the last sample
    np.testing.assert_allclose(
        speeds.ground, [disc_speed(ground, each) for each in (held_before, 3.0, 6.0, held_after)]
    )


def test_angles_of_discs_are_positions_of_motors_over_gears_with_their_signs():
    leg, ground = RIG.drives.leg, RIG.drives.ground
    samples = [
        Sample(t, None, None, (rate * t, rate), channel=drive.node)
        for t in (0.0, 1.0, 2.0)
        for drive, rate in ((leg, 2.0), (ground, 3.0))
    ]
    angles = decode_disc_angles(leg, ground, samples)
    speeds = decode_speeds(leg, ground, samples)
    for angle, speed in zip(angles, (speeds.leg, speeds.ground), strict=True):
        np.testing.assert_allclose(angle, speed * speeds.time)


def test_speeds_need_samples_of_both_drives():
    leg, ground = RIG.drives.leg, RIG.drives.ground
    with pytest.raises(ProtocolError, match=f"drive with node {ground.node}"):
        decode_speeds(leg, ground, [drive_sample(0.0, leg, 1.0)])
