# SPDX-License-Identifier: MIT
"""What a person is told about a run: its state, why, and which key does what."""

import pytest

from rig.experiment.condition import Condition, RigState
from rig.safety import StopCategory


@pytest.mark.parametrize("state", [RigState.STOPPED, RigState.LATCHED])
def test_no_key_acts_once_the_run_is_over(state):
    assert Condition(state, False).keys == "keys have no effect: the run has ended"


def test_only_stops_harder_than_the_one_obeyed_are_offered():
    keys = Condition(RigState.STOPPING, True, pending=StopCategory.SOFT).keys
    assert keys.startswith("Ctrl-C or ss + Enter: safe stop")
    assert "soft stop" not in keys
    assert "; e + Enter: emergency stop" in keys


def test_a_held_run_can_go_on_and_says_how_long_it_waits():
    keys = Condition(RigState.HOLDING, True, pending=StopCategory.SOFT, hold=5.0).keys
    assert keys.startswith("r + Enter: resume; ")
    assert keys.endswith("a safe stop follows unless resumed within 5 s")


@pytest.mark.parametrize(("energised", "why", "said"), [
    (True, "", "RUNNING, discs energised"),
    (False, "a fault", "RUNNING, discs de-energised: a fault"),
])  # fmt: skip
def test_the_headline_says_state_energy_and_reason(energised, why, said):
    assert Condition(RigState.RUNNING, energised, why).headline == said
