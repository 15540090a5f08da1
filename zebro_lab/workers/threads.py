# SPDX-License-Identifier: MIT
"""Map tasks over threads of this process."""

from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from model.mapping import Result, Shared, Task


@dataclass(frozen=True)
class Threads:
    """Mapper over threads, which share the cores as far as tasks are compiled loops and numpy's.

    Attributes:
        count: Largest number of threads.
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

        A map that is given up waits for the tasks that have begun.
        """
        pool = ThreadPoolExecutor(min(self.count, max(len(tasks), 1)))
        try:
            futures = [pool.submit(function, shared, task) for task in tasks]
            for future in futures:
                yield future.result()
        finally:
            pool.shutdown(cancel_futures=True)
