# SPDX-License-Identifier: MIT
"""Keys of a terminal command a run, whatever else is typed or pasted."""

import contextlib
import io
import os
import sys
import time

import pytest
from rich.console import Console

from rig.experiment.control import Control
from zebro_lab.experiment.screen import experiment_screen


@pytest.fixture(name="terminal")
def _terminal(monkeypatch):
    """Return the far end of a terminal that is standard input."""
    master, slave = os.openpty()
    keyboard = os.fdopen(slave, "r", encoding="utf-8", errors="strict")
    monkeypatch.setattr(sys, "stdin", keyboard)
    yield master
    for close in (keyboard.close, lambda: os.close(master)):
        with contextlib.suppress(OSError):
            close()


def holds(condition, longest=3.0):
    """Tell whether a condition comes to hold."""
    end = time.monotonic() + longest
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.01)
    return condition()


def type_in(terminal, typed, control, condition):
    console = Console(file=io.StringIO(), force_terminal=True, width=100)
    with experiment_screen(console, control):
        for part in typed:
            os.write(terminal, part)
            time.sleep(0.05)
        return holds(condition)


@pytest.mark.parametrize(
    "typed",
    [
        [b"note caf\xe9\n", b"e\n"],
        [b"\xff\xfe\x00\x80\n", b"e\n"],
        [b"\x04", b"\x04", b"e\n"],  # Ctrl-D ends a line, and of an empty one the input
        [b"x" * 3000 + b"\n", b"\xc3\x28\n", b"e\n"],
    ],
)
def test_nothing_that_is_typed_keeps_an_emergency_stop_from_being_heard(terminal, typed):
    control = Control()
    assert type_in(terminal, typed, control, lambda: control.stop.latched)


def test_a_terminal_that_is_gone_is_a_stop(terminal):
    control = Control()
    console = Console(file=io.StringIO(), force_terminal=True, width=100)
    with experiment_screen(console, control):
        time.sleep(0.05)
        os.close(terminal)
        assert holds(lambda: control.stop.pending is not None)
    assert "keyboard" in control.stop.pending.reason
