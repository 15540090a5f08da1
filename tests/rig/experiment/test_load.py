# SPDX-License-Identifier: MIT
"""The normal force is set by an axis or a person, within its tolerance or not at all."""

import math

import pytest

from rig.errors import RigTimeout
from rig.experiment.load import DrivenShaft, HandShaft
from rig.experiment.simulated_load import SimulatedAxis
from rig.experiment.watcher import ExperimentWatcher


def test_a_driven_axis_finds_the_loads_and_the_zero(lab):
    twin = lab["twin"]()
    axis = SimulatedAxis(twin.rig, clock=twin.clock)
    load = DrivenShaft(axis, tolerance=0.3, patience=30.0, clock=twin.clock)
    outcome = twin.run(load=load)
    assert outcome.completed
    zero = twin.sink.runs[0].start.zero
    assert abs(zero.normal) < 0.1
    for run in twin.sink.accepted:
        assert run.verdict.normal_force == pytest.approx(run.start.point.load, rel=0.7, abs=0.5)


def test_an_axis_that_brings_no_force_is_given_up(lab):
    twin = lab["twin"]()

    class Stuck:
        def move(self, velocity):
            pass

    load = DrivenShaft(Stuck(), tolerance=0.1, patience=2.0, clock=twin.clock)
    twin.rig.load = 2.0
    with pytest.raises(RigTimeout, match="the load axis did not reach 4 N"):
        twin.run(load=load)
    assert twin.at_rest()


def test_a_person_is_asked_and_believed_only_within_the_tolerance(lab):
    twin = lab["twin"]()
    twin.rig.load = 1e-3
    asked = []

    class Operator(ExperimentWatcher):
        def prompt(self, text, *, normal):
            asked.append(text)
            if asked.count(text) == 5:
                twin.control.confirm()  # too early where a force is wanted
            if asked.count(text) == 10:
                twin.rig.load = float(text.split()[5]) if "set" in text else 1e-3
            if asked.count(text) == 20:
                twin.control.confirm()

        def judged(self, point, verdict, *, attempt):
            pass

    load = HandShaft(twin.control, tolerance=3.0)  # the discs may stand on the bump
    outcome = twin.run(load=load, watcher=Operator())
    assert outcome.completed
    assert len([text for kind, text in twin.sink.events if kind == "prompt"]) == 3
    assert asked.count("set the normal force to 8 N +/- 3 N, then confirm") >= 5


def test_a_shaft_without_a_tolerance_is_prompted_without_one(lab):
    load = HandShaft(lab["twin"]().control, tolerance=math.inf)
    assert load.request(4.9) == "set the normal force to 4.9 N, then confirm"
