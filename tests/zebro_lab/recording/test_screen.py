# SPDX-License-Identifier: MIT
"""A display on a terminal, lines elsewhere, and keys and signals that end a recording."""

import io
import os
import signal
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

from rig.device import Counters
from zebro_lab.recording import screen as module
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


@pytest.mark.parametrize("terminal", [False, True])
def test_a_note_is_one_line_whatever_it_holds(terminal):
    place = console(terminal=terminal)
    RecordScreen(place).note("legs \x1b[31m [bold]3[/] " + "are slow " * 20)
    (line,) = written_on(place).splitlines()
    assert line.startswith("legs \\x1b[31m [bold]3[/] are slow")


def test_a_pipe_gets_a_line_now_and_then(monkeypatch):
    place, now = console(terminal=False), [0.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    with record_screen(place) as screen:
        for now[0] in (1.0, 9.9, 10.1, 15.0, 19.0, 20.2):
            screen.show(RecordStatus(Path("run"), now[0], 60.0, STREAMS))
        assert screen.stop_reason() is None
        assert screen.close()
    lines = written_on(place).splitlines()
    assert [line.split(" s left")[0] for line in lines] == [
        "10 of 60 s recorded, 50", "20 of 60 s recorded, 40",
    ]  # fmt: skip
    assert "legs SIMULATED, 100 Hz, 56 lost, 8 dropped, 7 rejected, 1234 received" in lines[0]
    assert "\x1b" not in written_on(place)


def test_a_pipe_that_takes_no_line_is_told_at_the_end(monkeypatch):
    entered, free = threading.Event(), threading.Event()

    def hang(_):
        entered.set()
        free.wait(20)

    place = Console(file=SimpleNamespace(write=hang, flush=lambda: None))
    monkeypatch.setattr(module, "LINE_EVERY", 0.0)
    with record_screen(place) as screen:
        status = RecordStatus(Path("run"), 1.0, None, STREAMS)
        writer = threading.Thread(target=screen.show, args=(status,), daemon=True)
        writer.start()
        try:
            assert entered.wait(20)
            assert not screen.close()
        finally:
            free.set()
        writer.join(5)
        assert screen.close()


def test_a_pipe_that_nobody_reads_any_more_is_not_waited_for(monkeypatch):
    def broken(_):
        raise BrokenPipeError

    place = Console(file=SimpleNamespace(write=broken, flush=lambda: None))
    monkeypatch.setattr(module, "LINE_EVERY", 0.0)
    with record_screen(place) as screen:
        with pytest.raises((OSError, SystemExit)):
            screen.show(RecordStatus(Path("run"), 1.0, None, STREAMS))
        assert screen.close()


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


@pytest.mark.parametrize("typed", [b"", b"x", b"q", b"xq", b"\xe4\xff q", b"\xc3", b"\xffq"])
def test_a_key_is_a_wish_to_stop_and_no_other_byte_hides_it(typed):
    reading, writing = os.pipe()
    with os.fdopen(reading) as keys, os.fdopen(writing, "wb", buffering=0) as typist:
        screen = RecordScreen(console(terminal=True), None, keys)
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
        assert not screen.signalled


def test_a_keyboard_that_is_gone_is_a_stop():
    reading, writing = os.pipe()
    os.close(writing)
    with os.fdopen(reading) as keys:
        screen = RecordScreen(console(terminal=True), None, keys)
        assert screen.stop_reason() == "terminal closed"
        assert screen.signalled


@pytest.mark.parametrize("outlives", [False, True])
def test_a_lost_connection_is_a_stop_unless_the_recording_is_told_to_outlive_it(outlives):
    heard = []
    handler = signal.SIG_IGN if outlives else lambda *_: heard.append("unheard")
    before = signal.signal(signal.SIGHUP, handler)
    try:
        with record_screen(console(terminal=False)) as screen:
            for _ in range(3):
                signal.raise_signal(signal.SIGHUP)
            expected = (None, False) if outlives else ("SIGHUP", True)
            assert (screen.stop_reason(), screen.signalled) == expected
            assert heard == []
    finally:
        signal.signal(signal.SIGHUP, before)
