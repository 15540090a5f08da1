# SPDX-License-Identifier: MIT
"""Protocol of a map of independent tasks over workers, and the one that needs none."""

from collections.abc import Callable, Generator, Sequence
from typing import Final, Protocol, TypeVar

Shared = TypeVar("Shared")
Task = TypeVar("Task")
Result = TypeVar("Result")


class Mapper(Protocol):
    """Computes a function of independent tasks somewhere: here, in threads, on a cluster.

    Results depend on nothing but the function, what the tasks share, and the task, which carries
    its own seed; they are therefore the same wherever they are computed.
    """

    def map(
        self,
        function: Callable[[Shared, Task], Result],
        shared: Shared,
        tasks: Sequence[Task],
        *,
        interpreted: float = 0.0,
    ) -> Generator[Result]:
        """Yield `function(shared, task)` of each task, in the order of the tasks.

        Closing the generator before its end gives up the tasks that are left.

        Args:
            function: A function on module level, since it is sent by name.
            shared: What all tasks share; can be pickled.
            tasks: What differs; can be pickled.
            interpreted: About how long all tasks take one core outside of compiled loops, by their
                size [s]. Threads compute that in turn; where it is long, processes are worth it.
        """
        ...


class Here:
    """Mapper that computes one task after the other in this process."""

    def map(
        self,
        function: Callable[[Shared, Task], Result],
        shared: Shared,
        tasks: Sequence[Task],
        *,
        interpreted: float = 0.0,
    ) -> Generator[Result]:
        """Yield the results, each computed when it is asked for; see `Mapper.map`."""
        for task in tasks:
            yield function(shared, task)


HERE: Final = Here()
