# SPDX-License-Identifier: MIT
"""Map tasks over the cores of this machine, by threads or processes as the work is small or large.

Threads begin at once, and share the cores as far as tasks are compiled loops; all else they compute
in turn. Processes share all, and take seconds to start.
"""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Final

from model.mapping import Mapper, Result, Shared, Task
from zebro_lab.workers.processes import Processes
from zebro_lab.workers.threads import Threads

WORTH: Final = 20.0
"""Work outside of compiled loops from which on processes are started [s], which takes 2 to 3 s."""


@dataclass(frozen=True)
class Cores:
    """Mapper over the cores of this machine.

    Attributes:
        count: Number of cores to use.
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
        """Yield the results in order; see `model.mapping.Mapper.map`."""
        count = min(self.count, max(len(tasks), 1))
        large = count > 1 and interpreted > WORTH
        mapper: Mapper = Processes(count) if large else Threads(count)
        return mapper.map(function, shared, tasks)
