# SPDX-License-Identifier: MIT
"""Signals come after what must not be interrupted."""

import signal
import threading

import pytest

from zebro_lab.files.uninterrupted import uninterrupted


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_handled_after_the_body_once(number):
    order: list[str] = []
    earlier = signal.signal(number, lambda *_: order.append("handled"))
    try:
        with uninterrupted():
            signal.raise_signal(number)
            signal.raise_signal(number)
            order.append("done")
    finally:
        signal.signal(number, earlier)
    assert order == ["done", "handled"]


def test_handlers_are_as_before_also_after_an_error():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(ZeroDivisionError), uninterrupted():
        raise ZeroDivisionError
    assert signal.getsignal(signal.SIGTERM) is before


def test_another_thread_is_not_refused():
    ran: list[int] = []

    def act() -> None:
        with uninterrupted():
            ran.append(1)

    thread = threading.Thread(target=act)
    thread.start()
    thread.join()
    assert ran == [1]
