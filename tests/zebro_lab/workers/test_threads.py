# SPDX-License-Identifier: MIT
"""Threads give the numbers of this thread, in order, and end with the map."""

import threading

import pytest

from model.mapping import HERE
from support.mapped_tasks import fail, normal
from zebro_lab.workers.threads import Threads


def test_numbers_are_those_of_this_thread_in_order():
    assert list(Threads(3).map(normal, 3.0, range(7))) == list(HERE.map(normal, 3.0, range(7)))
    assert list(Threads(3).map(normal, 3.0, [])) == []


def test_an_error_of_a_task_is_raised_and_the_threads_end():
    before = threading.active_count()
    with pytest.raises(ValueError, match="task 0"):
        list(Threads(2).map(fail, None, [0, 1]))
    assert threading.active_count() == before


def test_a_map_that_is_given_up_begins_no_further_task():
    begun, go_on = [], threading.Event()

    def wait(_, task):
        begun.append(task)
        if task:
            go_on.wait(5)

    results = Threads(1).map(wait, None, range(9))
    next(results)
    threading.Timer(0.1, go_on.set).start()
    results.close()
    assert len(begun) <= 2
