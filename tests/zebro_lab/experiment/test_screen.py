# SPDX-License-Identifier: MIT
"""What a person sees of an experiment, on a terminal and in a pipe."""

import contextlib
import io
import os
import sys
import time

import pytest
from rich.console import Console

from rig.experiment.condition import Condition, RigState
from rig.experiment.control import Control
from rig.experiment.steps import Point
from rig.experiment.verdict import PointVerdict
from rig.safety import StopCategory
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.experiment.screen import ExperimentScreen, experiment_screen
from zebro_lab.experiment.stage import run_experiment


def test_a_terminal_sees_progress_prompt_and_verdict():
    console = Console(file=io.StringIO(), force_terminal=True, width=100)
    with experiment_screen(console, Control()) as screen:
        screen.doing("point-0001", done=1, of=4, left=75.0)
        screen.prompt("set it", normal=3.2)
        verdict = PointVerdict((), 100, 0.1, 0.3, 4.0)
        screen.judged(Point(1, 4.0, (0.1,)), verdict, attempt=1)
    shown = console.file.getvalue()
    assert "1 of 4 points finished, 1 min 15 s left" in shown
    assert "set it; it is 3.20 N now" in shown
    assert "friction coefficient 0.300" in shown


def test_without_a_terminal_a_prompt_is_one_line():
    console = Console(file=io.StringIO())
    screen = ExperimentScreen(console, None)
    for normal in (1.0, 2.0, 3.0):
        screen.prompt("set it", normal=normal)
    screen.draw()
    assert console.file.getvalue() == "set it\n"


def test_a_quiet_screen_prints_what_waits_for_a_person_alone():
    console = Console(file=io.StringIO(), force_terminal=True, width=500)
    with experiment_screen(console, Control(), quiet=True) as screen:
        for state in (RigState.RUNNING, RigState.HOLDING, RigState.STOPPED):
            screen.changed(Condition(state, energised=True, hold=600.0))
        screen.notice("a point is measured again")
        screen.doing("point-0001", done=1, of=4, left=75.0)
        screen.judged(Point(1, 4.0, (0.1,)), PointVerdict((), 9, 0.1, 0.3, 4.0), attempt=1)
        screen.prompt("set the normal force to 4 N, then confirm", normal=3.2)
    held, prompt = console.file.getvalue().splitlines()
    assert "HOLDING" in held
    assert prompt == "set the normal force to 4 N, then confirm"


def test_text_of_a_plan_cannot_command_the_terminal():
    console = Console(file=io.StringIO())
    screen = ExperimentScreen(console, None)
    screen.notice("a [red]label\x1b[2J\ncompleted")
    screen.draw()
    assert console.file.getvalue() == "a [red]label\\x1b[2J\\ncompleted\n"


def test_a_pipe_that_nobody_reads_is_named(monkeypatch):
    # Rich puts /dev/null in the place of the standard output, which here is the tests' own.
    monkeypatch.setattr(os, "dup2", lambda *_: None)
    read, write = os.pipe()
    os.close(read)
    with contextlib.suppress(BrokenPipeError), os.fdopen(write, "w") as pipe:
        screen = ExperimentScreen(Console(file=pipe), None)
        screen.notice("begin")
        screen.close()
        with pytest.raises(BrokenPipeError, match="nobody reads"):
            screen.draw_on()


def test_a_hold_is_visible_and_says_which_key_goes_on(short, tmp_path):
    control = Control()

    class Holding(ExperimentScreen):
        def judged(self, point, verdict, *, attempt):
            super().judged(point, verdict, attempt=attempt)
            control.stop.request(StopCategory.SOFT, "Ctrl-C")

    short.write_text(short.read_text().replace("hold = 600.0", "hold = 1.0"))
    console = Console(file=io.StringIO(), width=200)
    request = RigRunRequest(short, "sim", tmp_path / "data", fast=True)
    screen = Holding(console, None)
    run_experiment(request, screen, control)
    screen.draw()
    shown = console.file.getvalue()
    assert "HOLDING" in shown
    assert "discs energised" in shown
    assert "r + Enter: resume" in shown
    assert "safe stop" in shown


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
