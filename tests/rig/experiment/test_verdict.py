# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from rig.experiment.readings import Readings
from rig.experiment.steps import Point
from rig.experiment.verdict import friction, halves, is_steady, judge_point
from rig.slip_rig.profile import load_rig_profile

PROFILE = load_rig_profile("rig-board-serial")
LEG = 12.0


def readings(*, slip=0.2, friction=0.3, load=5.0, n=200, duration=0.5):
    """Make readings; slip, friction and load are numbers or arrays of shape (n,)."""
    t = np.linspace(0.0, duration, n)
    ground = LEG * PROFILE.radius_leg * (1 - slip * np.ones(n)) / PROFILE.radius_ground
    normal = load * np.ones(n)
    return Readings(t, np.full(n, LEG), ground, normal, friction * normal)


def judge(found, plan, *, settled=True, slip=0.2):
    return judge_point(
        found, Point(1, 5.0, (slip,)), plan.accept, settled=settled, duration=0.5, profile=PROFILE
    )


def test_a_steady_point_is_good(lab):
    verdict = judge(readings(), lab["plan"]())
    assert verdict.accepted
    assert (verdict.slip, verdict.friction) == (pytest.approx(0.2), pytest.approx(0.3))


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (readings(slip=0.25), "mean slip ratio is +0.0500 off its set-point"),
        (readings(slip=np.linspace(0.16, 0.24, 200)), "slip ratio drifted by +0.04"),
        (readings(friction=np.linspace(0.0, 0.8, 200)), "friction drifted by +0.4"),
        (readings(n=5), "5 samples"),
        (readings(duration=0.2), "the samples cover 0.20 s of the 0.5 s"),
    ],
)
def test_what_is_wrong_with_a_point_is_said(lab, found, said):
    verdict = judge(found, lab["plan"]())
    assert not verdict.accepted
    assert any(problem.startswith(said) for problem in verdict.problems), verdict.problems


def test_a_point_that_had_not_settled_is_not_good(lab):
    assert judge(readings(), lab["plan"](), settled=False).problems == (
        "the rig was not steady within settle.timeout",
    )


def test_the_bump_of_the_ground_disc_does_not_look_like_drift(lab):
    bump = 5.0 * (1 + 0.6 * (np.arange(200) > 120))
    assert judge(readings(load=bump), lab["plan"]()).accepted


def test_both_halves_share_all_samples():
    found = readings(n=101)
    first, late = halves(found)
    assert len(first) + len(late) == 101
    assert first.t[-1] < late.t[0]
    assert np.isnan(friction(readings(load=0.0)))


def test_steady_is_what_agrees_in_both_halves_at_the_set_points(lab):
    criterion = lab["plan"](settle={"window": 0.5}).settle
    wanted = (LEG, LEG * PROFILE.radius_leg * 0.8 / PROFILE.radius_ground)
    assert is_steady(readings(), wanted, criterion)
    assert not is_steady(readings(duration=0.2), wanted, criterion)  # the window is not full
    assert not is_steady(readings(), (LEG + 1, wanted[1]), criterion)
    assert not is_steady(readings(friction=np.linspace(0, 1, 200)), wanted, criterion)
    assert not is_steady(readings(slip=np.linspace(-0.2, 0.6, 200)), wanted, criterion)
