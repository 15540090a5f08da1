# SPDX-License-Identifier: MIT
"""The cores of this machine are used by threads, and by processes where the work is worth it."""

import os

import pytest

from zebro_lab.workers.machine import WORTH, Cores


def process(_, task):
    return task, os.getpid()


@pytest.mark.parametrize(
    ("cores", "tasks", "interpreted"), [(2, 3, 0.0), (2, 3, WORTH), (1, 3, 2 * WORTH)]
)
def test_small_work_stays_in_this_process(cores, tasks, interpreted):
    found = list(Cores(cores).map(process, None, range(tasks), interpreted=interpreted))
    assert found == [(task, os.getpid()) for task in range(tasks)]


def test_one_task_stays_in_this_process_however_large():
    assert list(Cores(2).map(process, None, [7], interpreted=9 * WORTH)) == [(7, os.getpid())]


def test_large_work_goes_to_processes(monkeypatch):
    begun = []

    class Processes:
        def __init__(self, count):
            begun.append(count)

        def map(self, _function, _shared, tasks):
            yield from tasks

    monkeypatch.setattr("zebro_lab.workers.machine.Processes", Processes)
    assert list(Cores(5).map(process, None, range(3), interpreted=2 * WORTH)) == [0, 1, 2]
    assert begun == [3]
