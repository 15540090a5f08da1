# SPDX-License-Identifier: MIT
"""The simulated operator sets a load at once; the simulated axis presses like a spring."""

import pytest

from rig.clock import ManualClock
from rig.experiment.simulated_load import LEAST, SimulatedAxis, SimulatedOperator


class Rig:
    load = 2.0


def test_the_operator_sets_the_load_exactly_and_is_done():
    rig = Rig()
    operator = SimulatedOperator(rig)
    assert operator.request(6.5) == ""
    assert rig.load == 6.5
    assert operator.follow(0.0)
    operator.request(0.0)
    assert rig.load == LEAST


def test_the_axis_adds_stiffness_times_distance():
    rig, clock = Rig(), ManualClock()
    axis = SimulatedAxis(rig, stiffness=1000.0, clock=clock)
    axis.move(0.002)
    assert rig.load == 2.0  # nothing has moved yet
    clock.sleep(0.5)
    axis.move(-0.1)
    assert rig.load == pytest.approx(3.0)
    clock.sleep(1.0)
    axis.move(0.0)
    assert rig.load == LEAST  # it lifts off and pulls at nothing
