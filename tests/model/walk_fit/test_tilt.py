# SPDX-License-Identifier: MIT
"""Roll and pitch of an IMU, on walks simulated by the model itself: the truth is known."""

import numpy as np
import pytest

from model.errors import InsufficientData
from model.gait import tripod_angles, tripod_reference
from model.gait.reference import SampledReference
from model.robot import Robot
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.ensemble import WalkDraw, walk_ensemble
from model.walk.traction import VelocityCoulomb
from model.walk_fit.tilt import SD, MeasuredTilt, TiltMisfit

DURATION = 8.0
TABLE = VelocityCoulomb(0.38).table(weight=21.3)
GAIT = tripod_reference(tripod_angles(np.radians(50.0), 1.2), 2.0)
OPTIONS = DynamicsOptions(dt=0.005)


def log(duration=DURATION):
    t = np.arange(0.0, duration + 0.005, 0.01)
    return SampledReference(t, GAIT.angles(t))


def tilted(*offsets, duration=DURATION):
    """Walk with each of some offsets of the legs [deg]; return times, and roll and pitch."""
    t = np.arange(0.0, duration, 0.02)
    draws = [WalkDraw(Robot(leg_offset=np.radians(each)), log(duration), TABLE) for each in offsets]
    return t, walk_ensemble(draws, t, options=OPTIONS, tilt=True).tilt


def off(leg, degrees):
    return degrees * np.eye(6)[leg - 1]


def squares(misfit, tilt):
    return (misfit.residuals(tilt) ** 2).sum(axis=1)


def test_an_ensemble_tilts_as_its_walk_does():
    t, tilt = tilted(off(3, 5.0))
    path = walk(
        Robot(leg_offset=np.radians(off(3, 5.0))), log(), TABLE, duration=DURATION, options=OPTIONS
    )
    alone = np.column_stack([np.interp(t, path.t, a) for a in path.orientation[:, :2].T])
    np.testing.assert_allclose(tilt[0], alone, atol=1e-12)


def test_the_leg_that_is_off_is_told_from_one_that_bends_the_path_alike():
    t, tilt = tilted(off(3, 5.0), off(1, 6.0), off(3, 4.0), np.zeros(6))
    misfit = TiltMisfit.of(MeasuredTilt(t, tilt[0]), t, log())
    right, other, near, none = squares(misfit, tilt)
    assert right < 1e-12
    assert near < 0.2 * none
    assert other - near > 10.0  # twice the log of how much likelier the right leg is


def test_how_a_unit_is_mounted_does_not_count():
    t, tilt = tilted(off(3, 5.0), np.zeros(6))
    level, mounted = (
        TiltMisfit.of(MeasuredTilt(t, tilt[0] + by), t, log())
        for by in (0.0, np.radians([1.0, -2.0]))
    )
    np.testing.assert_allclose(mounted.residuals(tilt), level.residuals(tilt), atol=1e-9)


def test_strides_that_repeat_say_as_much_as_one():
    said = []
    for duration in (8.0, 16.0):
        t, tilt = tilted(off(3, 5.0), np.zeros(6), duration=duration)
        misfit = TiltMisfit.of(MeasuredTilt(t, tilt[0]), t, log(duration))
        assert misfit.count == pytest.approx(2 * 2.0 / 0.1, rel=0.05)
        said.append(squares(misfit, tilt)[1])
    assert said[1] == pytest.approx(said[0], rel=0.1)


def test_a_difference_of_one_standard_deviation_counts_as_one():
    t = np.arange(0.0, 4.0, 0.02)
    still = SampledReference(t, np.zeros((len(t), 6)))
    misfit = TiltMisfit.of(MeasuredTilt(t, np.zeros((len(t), 2))), t, still)
    swing = SD * np.sign(np.sin(np.pi * (t + 0.01)))[:, None] * np.ones(2)
    assert squares(misfit, swing[None])[0] == pytest.approx(misfit.count, rel=0.05)


def test_an_imu_of_another_time_is_refused():
    t, tilt = tilted(np.zeros(6))
    with pytest.raises(InsufficientData, match="share"):
        TiltMisfit.of(MeasuredTilt(t + 100.0, tilt[0]), t, log())
