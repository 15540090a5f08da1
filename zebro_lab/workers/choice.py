# SPDX-License-Identifier: MIT
"""Open the workers that a request names."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

from model.mapping import Here, Mapper
from zebro_lab.workers.request import WorkersRequest


@contextmanager
def open_workers(request: WorkersRequest) -> Iterator[Mapper]:
    """Open the workers of a request: a cluster, processes of this machine, or this process alone.

    Args:
        request: Number of processes, or address of a scheduler.

    Yields:
        The mapper over them.

    Raises:
        ZebroLabError: A scheduler cannot be used; see `open_cluster`.
    """
    if request.scheduler is not None:
        from zebro_lab.workers.cluster import open_cluster

        with open_cluster(request.scheduler) as cluster:
            yield cluster
        return
    count = request.processes or os.cpu_count() or 1
    if count == 1:
        yield Here()
        return
    from zebro_lab.workers.processes import Processes

    yield Processes(count)
