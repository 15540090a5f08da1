# SPDX-License-Identifier: MIT
"""Counters on a terminal, silence elsewhere, and keys and signals that end a recording."""

import io
import os
import signal
import threading
from pathlib import Path

import pytest
from rich.console import Console
from rich.live import Live

from rig.device import Counters
from zebro_lab.recording.screen import RecordScreen, record_screen
from zebro_lab.recording.status import RecordStatus, StreamStatus

SIGNALS = (signal.SIGINT, signal.SIGTERM)
STREAMS = {
    "legs": StreamStatus("sim:zebro", 100.2, Counters(received=1234, lost=56, damaged=7), 8),
    "imu": StreamStatus("real", 0.0, Counters(), 0),
}


def console(*, terminal):
    return Console(file=io.StringIO(), force_terminal=terminal, width=100)


def written_on(place):
    return place.file.getvalue()


@pytest.mark.parametrize("duration", [None, 10.0])
def test_a_terminal_sees_counters_time_and_what_is_simulated(duration):
    place = console(terminal=True)
    with Live(console=place) as live:
        RecordScreen(live).show(RecordStatus(Path("run"), 4.0, duration, STREAMS))
    text = written_on(place)
    for part in ("legs SIMULATED", "100", "1234", "56", "7", "8"):
        assert part in text
    assert "imu SIMULATED" not in text
    assert ("6 s left" in text) == (duration is not None)


def test_nothing_is_drawn_in_a_pipe():
    place = console(terminal=False)
    with record_screen(place) as screen:
        screen.show(RecordStatus(Path("run"), 4.0, None, STREAMS))
        assert screen.stop_reason() is None
    assert written_on(place) == ""


@pytest.mark.parametrize("number", SIGNALS)
def test_the_first_signal_is_the_reason_and_the_second_is_obeyed(number):
    with record_screen(console(terminal=False)) as screen:
        signal.raise_signal(number)
        assert (screen.stop_reason(), screen.signalled) == (number.name, True)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(number)


def test_handlers_are_restored_after_an_exception():
    before = [signal.getsignal(number) for number in SIGNALS]
    with pytest.raises(RuntimeError, match="device"), record_screen(console(terminal=False)):
        raise RuntimeError("device")
    assert [signal.getsignal(number) for number in SIGNALS] == before


def test_a_key_is_a_wish_to_stop_and_others_are_not():
    reading, writing = os.pipe()
    with os.fdopen(reading) as keys, os.fdopen(writing, "wb", buffering=0) as typist:
        screen = RecordScreen(None, keys)
        assert screen.stop_reason() is None
        typist.write(b"x")
        assert screen.stop_reason() is None
        typist.write(b"q")
        assert screen.stop_reason() == "key"
        assert not screen.signalled


@pytest.mark.parametrize("typed", [b"xq", b"\xe4\xff q", b"\xc3", b"\xffq"])
def test_no_byte_typed_hides_the_key_that_stops(typed):
    reading, writing = os.pipe()
    with os.fdopen(reading) as keys, os.fdopen(writing, "wb", buffering=0) as typist:
        screen = RecordScreen(None, keys)
        typist.write(typed)
        heard = []
        asker = threading.Thread(target=lambda: heard.append(screen.stop_reason()), daemon=True)
        asker.start()
        asker.join(1.0)
        hung = asker.is_alive()
        typist.write(b"q")
        asker.join(1.0)
        assert not hung
        assert heard == [None if b"q" not in typed else "key"]


def test_a_keyboard_that_is_gone_is_a_stop():
    reading, writing = os.pipe()
    os.close(writing)
    with os.fdopen(reading) as keys:
        screen = RecordScreen(None, keys)
        assert screen.stop_reason() == "terminal closed"
        assert screen.signalled


def test_a_lost_connection_is_a_stop_however_often_it_is_told(monkeypatch):
    heard = []
    before = signal.signal(signal.SIGHUP, lambda *_: heard.append("unheard"))
    try:
        with record_screen(console(terminal=False)) as screen:
            for _ in range(3):
                signal.raise_signal(signal.SIGHUP)
            assert heard == []
            assert (screen.stop_reason(), screen.signalled) == ("SIGHUP", True)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_recording_told_to_outlive_its_terminal_does():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with record_screen(console(terminal=False)) as screen:
            signal.raise_signal(signal.SIGHUP)
            assert (screen.stop_reason(), screen.signalled) == (None, False)
    finally:
        signal.signal(signal.SIGHUP, before)
