# SPDX-License-Identifier: MIT
"""Commands to a run, and stops in their order."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.errors import ProtocolError
from rig.experiment.control import STOPS, Control
from rig.safety import Stop, StopCategory, StopSwitch


@given(st.lists(st.sampled_from(list(StopCategory)), min_size=1, max_size=6))
def test_the_hardest_stop_prevails_and_only_soft_ones_are_released(asked):
    switch = StopSwitch()
    for category in asked:
        switch.request(category, category.name)
    assert switch.pending.category is max(asked)
    assert switch.latched == (StopCategory.EMERGENCY in asked)
    switch.release()
    left = [category for category in asked if category is not StopCategory.SOFT]
    assert (switch.pending.category if switch.pending else None) == max(left, default=None)
    switch.reset()
    assert switch.pending is None


def test_commands_are_carried_out_and_answered():
    control = Control()
    control.status = "point 3 of 9"
    assert control.execute("status", who="a") == "point 3 of 9"
    assert control.execute(" pause\n", who="a") == "done"
    assert control.paused
    control.execute("note belt replaced", who="a")
    control.execute("confirm", who="a")
    control.execute("resume", who="a")
    assert not control.paused
    notes = [(note.kind, note.text) for note in control.take_notes()]
    assert notes == [("pause", "requested"), ("note", "a: belt replaced"), ("resume", "requested")]
    assert [control.take_confirmation() for _ in range(2)] == [True, False]


@pytest.mark.parametrize("command", STOPS)
def test_a_stop_has_its_category_and_who_asked_for_it(command):
    for line, reason in ((command, "requested by a"), (f"{command} smoke", "smoke")):
        control = Control()
        control.execute(line, who="a")
        assert control.stop.pending == Stop(STOPS[command], reason)


@pytest.mark.parametrize("line", ["", "note", "stopp", "status\x00"])
def test_another_command_is_refused_with_those_that_there_are(line):
    with pytest.raises(ProtocolError, match="expected pause, resume, confirm, note TEXT, soft"):
        Control().execute(line, who="a")
