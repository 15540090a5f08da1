# SPDX-License-Identifier: MIT
"""Long computations: independent tasks, by an executor if there is one, and their progress."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from typing import Protocol, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")


class Watcher(Protocol):
    """Receives progress of a long computation, for example a progress bar, and can stop it."""

    def step(self, what: str, fraction: float | None) -> None:
        """Report the current step and the fraction of it that is done.

        Args:
            what: Name of the step.
            fraction: Share of the step that is done [-]; None where it is unknown.
        """
        ...

    def stop_requested(self) -> bool:
        """Return whether the computation should stop at its next checkpoint."""
        ...


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
