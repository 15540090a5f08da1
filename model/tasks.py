# SPDX-License-Identifier: MIT
"""Compute independent tasks in order, here or by a `concurrent.futures.Executor`."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from typing import TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")


def compute_tasks(
    executor: Executor | None, function: Callable[[Task], Result], tasks: Sequence[Task]
) -> Iterator[Result]:
    """Yield `function(task)` of each task, in the order of the tasks.

    Results depend on nothing but the function and the task, which carries its own seed; they are
    therefore the same wherever they are computed.

    Args:
        executor: Where tasks are computed, such as threads or `distributed.Client.get_executor()`;
            None computes each in this thread when its result is asked for.
        function: The function; for processes and clusters one that can be pickled.
        tasks: The tasks; for processes and clusters they can be pickled.
    """
    return map(function, tasks) if executor is None else executor.map(function, tasks)
