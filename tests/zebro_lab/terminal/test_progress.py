# SPDX-License-Identifier: MIT
"""The bar on a terminal, its silence elsewhere, and what it makes of signals."""

import io
import signal

import pytest
from rich.console import Console

from zebro_lab.terminal import stopping
from zebro_lab.terminal.progress import ProgressBar, ProgressLines, progress_bar
from zebro_lab.terminal.stopping import StoppedBySignal

SIGNALS = (signal.SIGINT, signal.SIGTERM)


@pytest.fixture(autouse=True)
def no_watchdog(monkeypatch):
    """Let the tests outlive the time after which a stopped process is ended."""
    monkeypatch.setattr(stopping, "PATIENCE", 1e6)


def console(*, terminal: bool) -> Console:
    return Console(file=io.StringIO(), force_terminal=terminal, width=80)


def written_on(place: Console) -> str:
    assert isinstance(place.file, io.StringIO)
    return place.file.getvalue()


def use(bar: ProgressBar) -> None:
    bar.step("reading", None)
    for fraction in (0.0, 0.5, 1.0):
        bar.step("sampling", fraction)


@pytest.mark.parametrize("number", SIGNALS)
def test_first_signal_is_a_wish_to_a_step_that_listens_and_the_second_is_obeyed(number):
    with progress_bar(console(terminal=False)) as bar:
        bar.step("sampling", 0.0)
        assert not bar.stop_requested()
        signal.raise_signal(number)
        assert bar.stop_requested()
        with pytest.raises(StoppedBySignal):
            signal.raise_signal(number)


@pytest.mark.parametrize("number", SIGNALS)
def test_a_step_that_does_not_listen_is_stopped_at_once(number):
    with progress_bar(console(terminal=False)) as bar:
        bar.step("sampling", 0.0)
        assert not bar.stop_requested()
        bar.step("drawing", None)
        with pytest.raises(StoppedBySignal) as stopped:
            signal.raise_signal(number)
    assert stopped.value.code == 130


def test_a_wish_that_comes_too_late_for_a_step_is_obeyed_at_the_next_one():
    with progress_bar(console(terminal=False)) as bar:
        bar.step("sampling", 0.9)
        assert not bar.stop_requested()
        signal.raise_signal(signal.SIGTERM)
        bar.step("sampling", 1.0)
        with pytest.raises(StoppedBySignal):
            bar.step("drawing", None)


def test_wish_is_acknowledged_on_a_terminal_alone():
    for terminal in (True, False):
        place = console(terminal=terminal)
        with progress_bar(place) as bar:
            bar.stop_requested()
            signal.raise_signal(signal.SIGINT)
        assert ("Ctrl-C again to quit" in written_on(place)) == terminal


def test_handlers_are_restored_after_an_exception():
    before = [signal.getsignal(number) for number in SIGNALS]
    with pytest.raises(RuntimeError, match="fit"), progress_bar(console(terminal=False)):
        raise RuntimeError("fit")
    assert [signal.getsignal(number) for number in SIGNALS] == before


def test_terminal_sees_what_is_going_on_and_how_far_it_is():
    place = console(terminal=True)
    with progress_bar(place) as bar:
        use(bar)
    text = written_on(place)
    assert "reading" in text
    assert "sampling" in text
    assert "100 %" in text


def test_a_quiet_command_draws_nothing_on_a_terminal():
    place = console(terminal=True)
    with progress_bar(place, quiet=True) as bar:
        use(bar)
        bar.stop_requested()
        signal.raise_signal(signal.SIGINT)
    assert written_on(place) == ""


def test_lines_in_a_pipe_are_ten_seconds_apart_and_tell_the_time_of_the_step(capsys):
    now = 0.0
    lines = ProgressLines(lambda: now)
    for now in range(60):
        lines.show("reading" if now < 12 else "sampling", None if now < 12 else (now - 12) / 48)
    assert capsys.readouterr().err.splitlines() == [
        "reading: 0:10 of this step",
        "sampling: 17%, 0:08 of this step, about 0:40 left",
        "sampling: 38%, 0:18 of this step, about 0:30 left",
        "sampling: 58%, 0:28 of this step, about 0:20 left",
        "sampling: 79%, 0:38 of this step, about 0:10 left",
    ]
