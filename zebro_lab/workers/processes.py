# SPDX-License-Identifier: MIT
"""Map tasks over processes of this machine."""

import multiprocessing
import signal
import threading
import warnings
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from model.mapping import Result, Shared, Task
from zebro_lab.files.errors import ZebroLabError


class WorkerDied(ZebroLabError, RuntimeError):
    """A process of this machine ended before its task was done."""


@dataclass(frozen=True)
class Processes:
    """Mapper over processes, which are started for each map and end with it.

    Attributes:
        count: Largest number of processes.
    """

    count: int

    def map(
        self,
        function: Callable[[Shared, Task], Result],
        shared: Shared,
        tasks: Sequence[Task],
        *,
        interpreted: float = 0.0,
    ) -> Generator[Result]:
        """Yield the results in order; see `model.mapping.Mapper.map`.

        Raises:
            WorkerDied: A process was killed, for example for want of memory.
        """
        before = set(multiprocessing.active_children())
        pool = ProcessPoolExecutor(
            min(self.count, max(len(tasks), 1)),
            multiprocessing.get_context("spawn"),  # libraries have threads, which no fork survives
            _begin,
            (function, shared),
        )
        finished = False
        try:
            with _starting():
                futures = [pool.submit(_compute, task) for task in tasks]
            for future in futures:
                yield future.result()
            finished = True
        except BrokenProcessPool as error:
            raise WorkerDied(
                "a process ended before its task was done, perhaps for want of memory; try again "
                "with fewer --processes or --threads"
            ) from error
        finally:
            pool.shutdown(wait=finished, cancel_futures=True)
            if not finished:
                for child in set(multiprocessing.active_children()) - before:
                    child.terminate()


_task_function: Callable[[Any, Any], Any] | None = None
_task_shared: Any = None


def _begin(function: Callable[[Any, Any], Any], shared: object) -> None:
    """Prepare a process: keep what all tasks share."""
    global _task_function, _task_shared  # a process pool has no other place
    warnings.filterwarnings("ignore", message=r"\s*ArviZ is undergoing", category=FutureWarning)
    _task_function, _task_shared = function, shared


def _compute(task: object) -> Any:
    if _task_function is None:
        raise RuntimeError("the process was not prepared")
    return _task_function(_task_shared, task)


@contextmanager
def _starting() -> Iterator[None]:
    """Ignore Ctrl-C and hold SIGTERM back within the body, in the main thread, where it is heard.

    A process that is stopped while it starts another one does not know of it yet, and would leave
    it running.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    held: list[int] = []
    interrupt = signal.signal(signal.SIGINT, signal.SIG_IGN)  # what processes inherit
    terminate = signal.signal(signal.SIGTERM, lambda number, _frame: held.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, interrupt or signal.SIG_DFL)
        signal.signal(signal.SIGTERM, terminate or signal.SIG_DFL)
        if held:
            signal.raise_signal(signal.SIGTERM)
