# SPDX-License-Identifier: MIT
"""The end of any thread by an exception reaches the run, which stops."""

import os
import signal
import threading

import pytest

from rig.errors import PartFailed
from rig.experiment.control import Control
from rig.experiment.supervision import ENDING, signal_stops, start_thread, supervised
from rig.safety import StopCategory, StopSwitch


def test_a_part_that_fails_asks_for_a_safe_stop_and_is_named():
    control = Control()

    def fail():
        raise ValueError("torn")

    start_thread(fail, name="keyboard", control=control).join()
    assert control.stop.pending.category == StopCategory.SAFE
    assert "keyboard" in control.stop.pending.reason
    assert "torn" in control.stop.pending.reason


def test_a_part_that_ends_well_stops_nothing():
    control, done = Control(), threading.Event()
    start_thread(done.set, name="keyboard", control=control).join()
    assert done.is_set()
    assert control.stop.pending is None


def test_a_thread_that_cannot_start_stops_the_run(monkeypatch):
    control = Control()

    def refuse(thread):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threading.Thread, "start", refuse)
    with pytest.raises(PartFailed, match="keyboard failed"):
        start_thread(lambda: None, name="keyboard", control=control)
    assert control.stop.pending is not None


def test_any_thread_is_supervised_and_only_for_as_long_as_the_run_lasts():
    control, before = Control(), threading.excepthook

    def fail():
        raise ValueError("torn")

    with supervised(control):
        thread = threading.Thread(target=fail, name="stranger")
        thread.start()
        thread.join()
    assert "stranger" in control.stop.pending.reason
    assert threading.excepthook is before


def test_ctrl_c_asks_for_a_softer_stop_first():
    switch = StopSwitch()
    before = signal.getsignal(signal.SIGINT)
    with signal_stops(switch):
        found = []
        for _ in range(4):
            os.kill(os.getpid(), signal.SIGINT)
            found.append(switch.pending.category)
    assert found == [*StopCategory, StopCategory.EMERGENCY]
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("name", ENDING)
def test_a_signal_that_would_end_the_program_asks_for_a_safe_stop(name):
    switch, number = StopSwitch(), signal.Signals[name]
    before = signal.signal(number, signal.SIG_DFL)  # a shell's background job ignores SIGQUIT
    try:
        with signal_stops(switch):
            os.kill(os.getpid(), number)
    finally:
        signal.signal(number, before)
    assert (switch.pending.category, switch.pending.reason) == (StopCategory.SAFE, name)
