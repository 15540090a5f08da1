# SPDX-License-Identifier: MIT
"""The bar on a terminal, its silence elsewhere, and what it makes of signals."""

import io
import signal

import pytest
from rich.console import Console

from zebro_lab.terminal.progress import ProgressBar, progress_bar

SIGNALS = (signal.SIGINT, signal.SIGTERM)


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
def test_first_signal_is_a_wish_and_the_second_is_obeyed(number):
    with progress_bar(console(terminal=False)) as bar:
        assert not bar.stop_requested()
        signal.raise_signal(number)
        assert bar.stop_requested()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(number)


def test_wish_is_acknowledged_on_a_terminal_alone():
    for terminal in (True, False):
        place = console(terminal=terminal)
        with progress_bar(place):
            signal.raise_signal(signal.SIGINT)
        assert ("Ctrl-C again to quit" in written_on(place)) == terminal


def test_handlers_are_restored():
    before = [signal.getsignal(number) for number in SIGNALS]
    with progress_bar(console(terminal=False)):
        assert [signal.getsignal(number) for number in SIGNALS] != before
    assert [signal.getsignal(number) for number in SIGNALS] == before


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


def test_nothing_is_drawn_in_a_pipe():
    place = console(terminal=False)
    with progress_bar(place) as bar:
        use(bar)
    assert written_on(place) == ""
