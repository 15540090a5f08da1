# SPDX-License-Identifier: MIT
"""A command or option of an earlier version is answered by what to use instead."""

import pytest

from zebro_lab.terminal.removed import REMOVED, replacement


@pytest.mark.parametrize("typed", REMOVED)
def test_a_removed_name_is_unknown_and_answered_by_its_replacement(run_command, typed):
    words = ["walk", *typed.split()] if typed.startswith("--") else typed.split()
    ended = run_command(*words)
    assert ended.code == 2
    assert "No such " in ended.err or "is not one of" in ended.err
    assert REMOVED[typed] in " ".join(ended.err.split())


def test_a_name_is_looked_up_for_its_command_first(monkeypatch):
    monkeypatch.setitem(REMOVED, "--old", "Use A.")
    monkeypatch.setitem(REMOVED, "calibrate --old", "Use B.")
    assert replacement("calibrate", "--old") == "Use B."
    assert replacement("walk", "--old") == "Use A."
    assert replacement("", "old") is None
