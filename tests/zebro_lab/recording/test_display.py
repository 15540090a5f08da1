# SPDX-License-Identifier: MIT
"""A display is shown the newest status, and given up where it raises or hangs."""

import threading
import time

from support.recorders import until
from zebro_lab.recording import display as module
from zebro_lab.recording.display import Display


def test_the_last_status_is_shown_before_the_end():
    seen, gave_up = [], []
    display = Display(seen.append, give_up=gave_up.append)
    for number in range(100):
        display.show(number)
    display.close()
    assert seen[-1] == 99
    assert seen == sorted(seen)
    assert gave_up == []


def test_a_display_that_raises_is_given_up_once_and_says_why():
    gave_up, shown = [], []

    def show(status):
        shown.append(status)
        raise ValueError("torn")

    display = Display(show, give_up=gave_up.append)
    display.show(1)
    until(lambda: gave_up)
    display.show(2)
    display.close()
    assert shown == [1]
    assert len(gave_up) == 1
    assert "torn" in gave_up[0]


def test_a_display_that_hangs_is_given_up_and_holds_up_nothing(monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.05)
    gave_up, free = [], threading.Event()
    display = Display(lambda status: free.wait(20), give_up=gave_up.append)
    try:
        display.show(1)
        time.sleep(0.2)
        began = time.monotonic()
        display.show(2)
        until(lambda: gave_up)
        display.close()
        assert time.monotonic() - began < 10
    finally:
        free.set()
    assert len(gave_up) == 1
