# SPDX-License-Identifier: MIT
"""Tasks are computed in order, the same by every executor, and no further than asked."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context

import pytest

from model.tasks import compute_tasks

NORMALS = [0.5, 3.0, 12.0]


def test_results_come_in_order_and_no_earlier_than_asked_for():
    done = []
    results = compute_tasks(None, lambda task: done.append(task) or 10 * task, [3, 1, 2])
    assert next(results) == 30
    assert done == [3]
    assert list(compute_tasks(None, abs, [-3, 1, 2])) == [3, 1, 2]


@pytest.mark.parametrize(
    "pool", [ThreadPoolExecutor, partial(ProcessPoolExecutor, mp_context=get_context("spawn"))]
)
def test_numbers_are_the_same_by_every_executor(pool):
    function = partial(pow, 1.1)
    with pool(2) as executor:
        found = list(compute_tasks(executor, function, NORMALS))
        assert list(compute_tasks(executor, function, [])) == []
    assert found == list(compute_tasks(None, function, NORMALS))


def test_an_error_of_a_task_is_raised():
    with ThreadPoolExecutor(2) as executor, pytest.raises(TypeError):
        list(compute_tasks(executor, abs, ["text", 1]))
