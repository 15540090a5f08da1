# SPDX-License-Identifier: MIT
"""Processes give the numbers of this process, in order, and end with the map."""

import multiprocessing
import signal
import time
from multiprocessing.popen_spawn_posix import Popen

import pytest

from model.mapping import Here
from support.mapped_tasks import die, fail, normal, slow
from zebro_lab.workers.processes import Processes, WorkerDied


def children_end():
    end = time.monotonic() + 5
    while multiprocessing.active_children() and time.monotonic() < end:
        time.sleep(0.02)
    return not multiprocessing.active_children()


def test_numbers_are_those_of_this_process_and_ctrl_c_is_heard_again():
    handler = signal.getsignal(signal.SIGINT)
    found = list(Processes(2).map(normal, 3.0, range(7)))
    assert found == list(Here().map(normal, 3.0, range(7)))
    assert signal.getsignal(signal.SIGINT) is handler
    assert children_end()


def test_an_error_of_a_task_is_raised_and_the_processes_end():
    with pytest.raises(ValueError, match="task 0"):
        list(Processes(1).map(fail, None, [0, 1]))
    assert children_end()


def test_a_process_that_dies_is_told():
    with pytest.raises(WorkerDied, match="fewer --processes"):
        list(Processes(1).map(die, None, [0]))


def test_a_map_that_is_given_up_ends_its_processes_at_once():
    tasks = Processes(1).map(slow, None, [0, 1])
    timer = signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(TimeoutError()))
    signal.setitimer(signal.ITIMER_REAL, 1.0)
    try:
        with pytest.raises(TimeoutError):
            next(tasks)
    finally:
        signal.signal(signal.SIGALRM, timer)
    assert children_end()


def test_a_stop_while_a_process_starts_is_heard_once_the_process_is_known(monkeypatch):
    class Stopped(Exception):
        pass

    def stop(*_):
        raise Stopped

    def launch_while_stopped(popen, process):
        launch(popen, process)
        signal.raise_signal(signal.SIGTERM)
        known.append(popen.pid)

    known, launch = [], Popen._launch
    monkeypatch.setattr(Popen, "_launch", launch_while_stopped)
    before = signal.signal(signal.SIGTERM, stop)
    try:
        with pytest.raises(Stopped):
            list(Processes(2).map(slow, None, [0, 1]))
        assert signal.getsignal(signal.SIGTERM) is stop
    finally:
        signal.signal(signal.SIGTERM, before)
    assert len(known) == 2
    assert children_end()
