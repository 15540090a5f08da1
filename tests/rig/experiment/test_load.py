# SPDX-License-Identifier: MIT
"""The normal force is set by a person within its tolerance, or at once by a simulated one."""

from types import SimpleNamespace

from rig.experiment.load import LEAST, HandShaft, SimulatedOperator
from rig.experiment.sink import ExperimentWatcher


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
    assert len([text for kind, text in twin.sink.events if kind == "prompt"]) == 4  # the first zero
    assert asked.count("set the normal force to 8 N +/- 3 N, then confirm") >= 5


def test_the_simulated_operator_sets_the_load_exactly_and_is_done():
    rig = SimpleNamespace(load=2.0)
    operator = SimulatedOperator(rig)
    assert operator.request(6.5) == ""
    assert rig.load == 6.5
    assert operator.follow(0.0)
    operator.request(0.0)
    assert rig.load == LEAST
