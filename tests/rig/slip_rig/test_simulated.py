# SPDX-License-Identifier: MIT
"""The simulated slip rig against the physics that it stands for."""

import numpy as np
import pytest

from rig.errors import ProtocolError
from rig.slip_rig.imperfections import TYPICAL_RIG, with_load_noise
from rig.slip_rig.simulated import RigDynamics
from rig.slip_rig.sweep import SweepPlan
from support.board_twins import LAWS, PERFECT, world


@pytest.mark.parametrize("law", LAWS)
def test_a_rig_left_alone_glides_through_its_slips_and_obeys_its_law(law):
    plan = SweepPlan(slips=(0.0, 0.02, 0.1, 0.5), loads=(8.0,), duration=2.0)
    rig = world(law, plan=plan)
    chosen, values = LAWS[law]
    for hundredth in range(600):
        rig.advance(hundredth / 100)
        if hundredth in (200, 400):
            truth = rig.truth()
            np.testing.assert_allclose(
                truth.traction, chosen.force(truth.slip, truth.load, values), atol=1e-12
            )
    truth = rig.truth(4.0)
    late = RigDynamics().speed_lag
    at = np.interp([4.5 + late, 5.0 + late, 5.5 + late], truth.time, truth.slip)
    np.testing.assert_allclose(at, [0.2, 0.3, 0.4], atol=3e-3)


def test_the_same_seed_gives_the_same_rig_however_often_it_is_asked():
    def run(step):
        rig = world(imperfections=PERFECT, seed=4)
        rig.command("leg", 10.0)
        rig.command("ground", 2.0)
        rig.advance(0.0)
        for k in range(1, round(0.5 / step) + 1):
            rig.advance(k * step)
        return rig.truth()

    fine, coarse = run(0.005), run(0.05)
    np.testing.assert_allclose(fine.traction, coarse.traction, atol=1e-9)


def test_the_bump_raises_the_load_and_ripple_the_speed():
    rig = world(imperfections=TYPICAL_RIG, dynamics=RigDynamics(ripple=0.02))
    rig.advance(0.0)
    rig.command("leg", 12.0)
    rig.command("ground", 3.0)
    rig.advance(4.0)
    truth = rig.truth()
    assert truth.load.max() == pytest.approx(rig.load * 1.6, rel=1e-3)
    late = truth.omega_leg[-7000:]
    assert np.ptp(late) == pytest.approx(2 * 0.02 * 12.0, rel=0.05)


def test_the_normal_channel_has_the_noise_of_a_load_cell():
    plan = SweepPlan(loads=(8.0,))
    rig = world(imperfections=with_load_noise(PERFECT), plan=plan, seed=1)
    rig.command("leg", 0.0)
    rig.advance(0.0)
    rig.advance(1.0)
    normal, traction = rig.forces(np.arange(0.1, 0.9, 1e-3))
    assert np.std(normal) == pytest.approx(0.05 + 0.005 * 8.0, rel=0.1)
    assert not traction.any()


def test_a_standing_leg_disc_carries_no_force():
    rig = world()
    rig.command("leg", 0.0)
    rig.command("ground", 5.0)
    rig.advance(0.0)
    rig.advance(0.5)
    assert np.all(rig.truth().traction == 0)


def test_impossible_dynamics_are_refused():
    with pytest.raises(ProtocolError, match="speed_lag is 0 s"):
        RigDynamics(speed_lag=0.0)
    with pytest.raises(ProtocolError, match="not run yet"):
        world().truth()
