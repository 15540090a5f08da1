# SPDX-License-Identifier: MIT
"""Options of where independent tasks are computed: this machine's cores, or a Dask cluster."""

import ipaddress
import logging
import os
import re
import socket
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Final, TypeAlias

from typer import Option

from zebro_lab.files.errors import SettingsError, ZebroLabError
from zebro_lab.files.provenance import software
from zebro_lab.terminal.request_command import Range

if TYPE_CHECKING:
    from distributed import Client

ANSWERS_WITHIN: Final = 5.0
"""Time for a scheduler to answer, and for one of its workers to be there [s]."""
_ADDRESS: Final = re.compile(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[^\s:/\[\]]+):([1-9]\d{0,4})")


SchedulerOption: TypeAlias = Annotated[
    str | None,
    Option(
        metavar="tcp://HOST:PORT",
        help="Dask scheduler whose workers compute independent tasks, instead of this "
        "machine's cores; tls://HOST:PORT outside a network of your own.",
    ),
]


class ClusterError(ZebroLabError, ConnectionError):
    """A Dask cluster does not answer, has no workers, was lost, or has other packages."""


@dataclass(frozen=True)
class WorkersRequest:
    """Options of the workers; results are the same wherever they are computed."""

    threads: Annotated[
        int | None,
        Option(help="Cores of this machine to use; default: all."),
        Range(least=1),
    ] = None
    scheduler: SchedulerOption = None

    def __post_init__(self) -> None:
        """Raise `SettingsError` for the address of a scheduler that has another form."""
        if self.scheduler is not None and _ADDRESS.fullmatch(self.scheduler) is None:
            raise SettingsError(
                f"found '{self.scheduler}'; expected tcp://HOST:PORT or tls://HOST:PORT, as dask "
                "scheduler prints it, such as tcp://127.0.0.1:8786",
                key="--scheduler",
            )

    @property
    def cores(self) -> int:
        """Number of cores of this machine to use."""
        return self.threads or os.cpu_count() or 1


@contextmanager
def open_executor(request: WorkersRequest) -> Iterator[Executor]:
    """Open the executor of independent tasks: threads of this machine, or a cluster's workers.

    Raises:
        SettingsError: The scheduler is outside of private networks, or Dask is not installed.
        ClusterError: The scheduler does not answer or was lost, or its workers cannot be used.
    """
    if request.scheduler is None:
        threads = ThreadPoolExecutor(request.cores)
        try:
            yield threads
        finally:
            threads.shutdown(cancel_futures=True)
        return
    address = request.scheduler
    try:
        _require_private_network(address)
        from distributed import CancelledError, Client, KilledWorker

        logging.getLogger("distributed").setLevel(logging.CRITICAL + 1)  # ours say what matters
        client = Client(address, timeout=ANSWERS_WITHIN, set_as_default=False)
    except ImportError as error:
        advice = "needs Dask, which is not installed: pip install 'zebro-lab[cluster]'"
        raise SettingsError(advice, key="--scheduler") from error
    except (OSError, OverflowError, ValueError, TypeError) as error:
        if isinstance(error, ZebroLabError):
            raise
        raise ClusterError(
            f"{address}: no Dask scheduler answers within {ANSWERS_WITHIN:g} s; start one "
            "(dask scheduler), open its port, and give Dask's configuration certificates for tls"
        ) from error
    try:
        _require_same_packages(client, address)
        yield client.get_executor(pure=False)
    except (KilledWorker, CancelledError) as error:
        raise ClusterError(
            f"{address}: the scheduler or a task's workers ended; look at their logs"
        ) from error
    finally:
        client.close(timeout=ANSWERS_WITHIN)


def _require_private_network(address: str) -> None:
    """Raise `SettingsError` for an unencrypted scheduler beyond this machine and private networks.

    Whoever can speak to a scheduler can run any program on its workers, and who answers in its
    place can run any on this machine: results are pickles. Names are resolved; OSError if that
    fails.
    """
    found = _ADDRESS.fullmatch(address)
    if found is None or found[1] == "tls":
        return
    for each in socket.getaddrinfo(found[2].strip("[]"), int(found[3])):
        place = ipaddress.ip_address(str(each[4][0]).partition("%")[0])
        if not place.is_private:
            raise SettingsError(
                f"{address} is {place}, outside of this machine and of private networks; use "
                "tls:// with certificates, or a tunnel to 127.0.0.1",
                key="--scheduler",
            )


def _require_same_packages(client: "Client", address: str) -> None:
    """Raise `ClusterError` without workers, or for a worker with other versions of packages."""
    try:
        client.wait_for_workers(1, timeout=ANSWERS_WITHIN)
        found: Any = client.run(software)
    except (ImportError, OSError) as error:
        raise ClusterError(
            f"{address}: has no workers that can load zebro-lab ({error}); start some "
            f"(dask worker {address}), with the same version"
        ) from error
    for worker, versions in found.items():
        for name, version in software().items():
            if versions.get(name) != version:
                raise ClusterError(
                    f"{address}: {worker} has {name} {versions.get(name, 'missing')}, and this "
                    f"machine {version}; install the same versions on all"
                )
