# SPDX-License-Identifier: MIT
"""Open the workers that a request names."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

from model.mapping import HERE, Mapper
from zebro_lab.workers.request import CoresRequest, WorkersRequest


@contextmanager
def open_workers(request: WorkersRequest | CoresRequest) -> Iterator[Mapper]:
    """Open the workers of a request: a cluster, this machine's cores, or this process alone.

    Args:
        request: Number of processes or cores, or address of a scheduler.

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
    yield cores_of(request) if isinstance(request, CoresRequest) else _processes(request)


def cores_of(request: CoresRequest) -> Mapper:
    """Return the mapper over the cores of this machine that a request names."""
    if request.cores == 1:
        return HERE
    from zebro_lab.workers.machine import Cores

    return Cores(request.cores)


def _processes(request: WorkersRequest) -> Mapper:
    count = request.processes or os.cpu_count() or 1
    if count == 1:
        return HERE
    from zebro_lab.workers.processes import Processes

    return Processes(count)
