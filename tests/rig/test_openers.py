# SPDX-License-Identifier: MIT
"""Addresses choose profile, port and driver, real or simulated."""

import numpy as np

from model.gait.reference import SampledReference
from rig.links.serve import PortServer
from rig.openers import IMU_PROFILE, LEGS_PROFILE, imu_at, legs_at, resolve
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile

GAIT = SampledReference(np.array([0.0, 60.0]), np.array([np.zeros(6), np.full(6, 60.0)]))


def rng():
    return np.random.default_rng(0)


def test_sim_alone_is_the_twin_of_the_default_profile():
    assert resolve("sim", default=LEGS_PROFILE) == (LEGS_PROFILE, "sim")
    assert resolve("mine.toml@COM3", default=LEGS_PROFILE) == ("mine.toml", "COM3")


def test_a_port_is_real_whoever_serves_it(take):
    twin = robot_twin(load_leg_profile(LEGS_PROFILE), GAIT, rng=rng())
    with (
        PortServer(twin) as server,
        legs_at(f"{LEGS_PROFILE}@{server.port}", GAIT, rng=rng()) as legs,
        legs,
    ):
        assert legs.source == "real"  # nobody told it; who serves a twin does
        assert take(legs, 1)


def test_twins_say_that_they_are_simulated(take):
    with legs_at("sim", GAIT, rng=rng()) as legs, legs:
        assert (legs.source, legs.profile.name) == ("sim:zebro", LEGS_PROFILE)
        assert take(legs, 1)
    with imu_at(f"{IMU_PROFILE}@sim", name="imu2", rng=rng()) as unit, unit:
        assert (unit.source, unit.name) == ("sim:imu", "imu2")
        assert take(unit, 1)
