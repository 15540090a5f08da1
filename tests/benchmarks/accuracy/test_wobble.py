# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from benchmarks.accuracy.wobble import wobble
from model.errors import DomainError
from model.gait.tetrapod import tetrapod_reference
from model.robot import Robot

GAIT = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
START = (1, 4, 5)  # legs 2, 5 and 6, section 5-5-2
CYCLE = [{2, 3, 6}, {1, 3, 4, 6}, {1, 4, 5}, {2, 4, 5}, {2, 5, 6}]  # Eq. (3-33)


def walk(*, dt=0.002, duration=6.0, robot=None, **options):
    return wobble(robot or Robot(), GAIT, duration=duration, dt=dt, contact=START, **options)


def test_the_tetrapod_goes_through_the_sources_contact_states():
    states = [set(legs) for _, legs in walk().transitions()]
    assert states == [{2, 5, 6}, *CYCLE, *CYCLE]


def test_with_the_centre_of_mass_tested_at_every_step_there_is_one_more_state():
    states = [set(legs) for _, legs in walk(always_balanced=True).transitions()]
    assert states == [{2, 5, 6}, {2, 3, 5}, *CYCLE, {2, 3, 5}, *CYCLE]


def test_pitch_and_roll_repeat_every_cycle_once_walking():
    path = walk(duration=7.0)
    first, second = (path.t > 0.5) & (path.t < 3.5), path.t > 3.5
    n = min(first.sum(), second.sum())
    for angle in (path.roll, path.pitch):
        np.testing.assert_allclose(angle[second][:n], angle[first][:n], atol=np.radians(0.15))


def test_late_detection_makes_the_angles_jump_in_proportion_to_the_step():
    jumps = [np.abs(np.diff(walk(dt=dt, duration=3.0).pitch)).max() for dt in (0.008, 0.002)]
    assert 3 < jumps[0] / jumps[1] < 5


def test_a_robot_with_short_hips_wobbles_more():
    close = Robot(hips=Robot().hips * np.array([0.5, 1.0, 1.0]))
    assert np.ptp(walk(robot=close, duration=3.0).pitch) > 1.5 * np.ptp(walk(duration=3.0).pitch)


def test_the_start_defaults_to_where_the_robot_rests():
    path = wobble(Robot(), GAIT, duration=0.1)
    assert path.contact[0].sum() >= 3


def test_no_time_is_refused():
    with pytest.raises(DomainError, match="duration is 0 s"):
        wobble(Robot(), GAIT, duration=0.0)


@pytest.mark.reference
def test_orientation_swings_as_far_as_the_independent_engines(shared):
    import pandas as pd

    engine = pd.read_csv(shared / "virtual-world/walks/tetrapod_mu0.20_tc3.csv.gz")
    path = walk(duration=7.0, always_balanced=True)
    late = path.t > 3.0
    for ours, theirs in ((path.roll[late], engine["roll"]), (path.pitch[late], engine["pitch"])):
        assert np.abs(ours).max() == pytest.approx(theirs[engine["t"] > 3].abs().max(), abs=0.02)
