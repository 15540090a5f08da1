# SPDX-License-Identifier: MIT
"""A line is printed in time or given up, and the process ends at once."""

import io
import subprocess
import sys
import threading
import time

import pytest

from zebro_lab.terminal import timely_output
from zebro_lab.terminal.timely_output import in_time, say_in_time


@pytest.mark.parametrize("err", [False, True])
def test_a_line_is_written_whole(err, capsys):
    assert say_in_time("ended", err=err)
    assert capsys.readouterr() == (("", "ended\n") if err else ("ended\n", ""))


def test_a_blocked_terminal_is_given_up_in_time(monkeypatch):
    monkeypatch.setattr(timely_output, "PATIENCE", 0.05)
    release = threading.Event()
    before = time.monotonic()
    assert not in_time(release.wait)
    assert time.monotonic() - before < 1.0
    release.set()


def test_a_closed_terminal_is_no_error(monkeypatch):
    closed = io.StringIO()
    closed.close()
    monkeypatch.setattr("sys.stdout", closed)
    assert not say_in_time("ended")
    monkeypatch.setattr("sys.stdout", None)
    assert say_in_time("ended")


def test_a_line_is_said_where_no_thread_can_be_started(monkeypatch, capsys):
    def refuse(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threading.Thread, "start", refuse)
    assert say_in_time("ended")
    assert capsys.readouterr().out == "ended\n"


def test_leaving_at_once_waits_for_nothing_and_has_its_code():
    code = (
        "import threading, time; from zebro_lab.terminal.timely_output import leave_at_once\n"
        "threading.Thread(target=time.sleep, args=(60,)).start(); leave_at_once(7)"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=30).returncode == 7
