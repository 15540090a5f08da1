# SPDX-License-Identifier: MIT
"""Map tasks over the workers of a Dask cluster."""

import logging
import threading
import warnings
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from model.mapping import Result, Shared, Task
from zebro_lab.files.errors import SettingsError, ZebroLabError
from zebro_lab.files.provenance import software
from zebro_lab.workers.address import OPTION, parse_address, require_own_network

if TYPE_CHECKING:
    from distributed import Client

ANSWERS_WITHIN: Final = 5.0
"""Time for a scheduler to answer, and for one of its workers to be there [s]."""


class ClusterError(ZebroLabError, ConnectionError):
    """A Dask cluster does not answer, has no workers, or has other versions of packages."""


@dataclass(frozen=True)
class Cluster:
    """Mapper over the workers of a connected cluster.

    What tasks share is sent with each of them, so that a task can be done again by any worker when
    the one that had it is lost.

    Attributes:
        client: The connection.
        address: Address of the scheduler, for messages.
        versions: Versions of packages on this machine, which a worker must have.
    """

    client: "Client"
    address: str
    versions: Mapping[str, str]

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
            ClusterError: The scheduler was lost, a task lost its worker four times, or a worker
                that came later has other versions of packages.
        """
        futures = [
            self.client.submit(compute, function, shared, task, self.versions, pure=False)
            for task in tasks
        ]
        try:
            for future in futures:
                yield self._result(future)
                future.release()
        finally:
            if self.client.status == "running":
                self.client.cancel([each for each in futures if not each.done()])

    def _result(self, future: Any) -> Any:
        from distributed import CancelledError, KilledWorker

        try:
            return future.result()
        except KilledWorker as error:
            raise ClusterError(
                f"{self.address}: a task ended four workers, perhaps for want of memory; look at "
                "the logs of the workers"
            ) from error
        except (CancelledError, OSError) as error:
            if isinstance(error, ZebroLabError) or self.client.status == "running":
                raise
            raise ClusterError(
                f"{self.address}: the scheduler was lost before all tasks were done; start it "
                "again, and repeat the command"
            ) from error


def compute(
    function: Callable[[Any, Any], Any], shared: object, task: object, versions: Mapping[str, str]
) -> Any:
    """Compute a task on a worker, which has the packages of the machine that asks.

    Args:
        function: Function of `shared` and `task`.
        shared: What all tasks share.
        task: The task.
        versions: Versions of packages on the machine that asks.

    Raises:
        ClusterError: The worker has other versions.
    """
    warnings.filterwarnings("ignore", message=r"\s*ArviZ is undergoing", category=FutureWarning)
    difference = differing({"a worker": software()}, versions)
    if difference:
        raise ClusterError(difference)
    return function(shared, task)


@contextmanager
def open_cluster(text: str) -> Iterator[Cluster]:
    """Connect to a scheduler, and check that its workers have the packages of this machine.

    Args:
        text: Address of the scheduler, `tcp://HOST:PORT` or `tls://HOST:PORT`; certificates for
            `tls` come from Dask's own configuration.

    Yields:
        The mapper.

    Raises:
        SettingsError: The address cannot be used, or Dask is not installed.
        ClusterError: The scheduler does not answer, has no workers, or a worker has other versions
            of packages, or none.
    """
    address = parse_address(text)
    require_own_network(address)
    try:
        from distributed import Client
    except ImportError as error:
        raise SettingsError(
            "needs Dask, which is not installed: pip install 'zebro-lab[cluster]'", key=OPTION
        ) from error
    with _quiet_dask():
        try:
            client = _in_time(lambda: Client(text, timeout=ANSWERS_WITHIN, set_as_default=False))
        except (OSError, ValueError, TypeError) as error:
            raise ClusterError(
                f"{text}: no Dask scheduler answers within {ANSWERS_WITHIN:g} s; is it running "
                f"(dask scheduler), and is the port open{_certificates(address.protocol)}?"
            ) from error
        try:
            versions = software()
            _require_same(client, text, versions)
            yield Cluster(client, text, versions)
        finally:
            client.close(timeout=ANSWERS_WITHIN)


def _in_time(connect: Callable[[], "Client"]) -> "Client":
    """Connect in a thread, since Dask waits for ever for a program that accepts and says nothing.

    Raises:
        TimeoutError: There is no connection after twice `ANSWERS_WITHIN`. Other errors are those of
            the connection.
    """
    found: list[Client] = []
    errors: list[Exception] = []

    def run() -> None:
        try:
            found.append(connect())
        except Exception as error:  # of any kind: it is raised again below
            errors.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(2 * ANSWERS_WITHIN)
    if errors:
        raise errors[0]
    if not found:
        raise TimeoutError
    return found[0]


def differing(found: Mapping[str, Mapping[str, str]], expected: Mapping[str, str]) -> str:
    """Describe the first worker whose packages differ from those of this machine; empty for none.

    Args:
        found: Versions of packages by worker.
        expected: Versions of packages on this machine.

    >>> differing({"w1": {"numpy": "2.0"}}, {"numpy": "2.1"})
    'w1 has numpy 2.0, and this machine 2.1; install the same versions on all'
    """
    for worker, versions in found.items():
        others = [name for name in expected if versions.get(name) != expected[name]]
        if others:
            said = ", ".join(
                f"{name} {versions.get(name, 'missing')}, and this machine {expected[name]}"
                for name in others
            )
            return f"{worker} has {said}; install the same versions on all"
    return ""


def _require_same(client: "Client", text: str, versions: Mapping[str, str]) -> None:
    """Raise `ClusterError` without workers, or for a worker with other versions of packages."""
    try:
        client.wait_for_workers(1, timeout=ANSWERS_WITHIN)
    except TimeoutError as error:
        raise ClusterError(
            f"{text}: the scheduler has no workers; start some (dask worker {text})"
        ) from error
    try:
        found: Any = client.run(software)
    except Exception as error:  # what the worker raised, of any kind
        raise ClusterError(
            f"{text}: a worker cannot load zebro-lab ({error}); install the same version there"
        ) from error
    difference = differing(found, versions)
    if difference:
        raise ClusterError(f"{text}: {difference}")


def _certificates(protocol: str) -> str:
    return ", and has Dask's configuration the certificates" if protocol == "tls" else ""


@contextmanager
def _quiet_dask() -> Iterator[None]:
    """Keep Dask's own log and warnings from the terminal: what matters is an error of ours."""
    handlers = logging.getLogger("distributed").handlers  # which its loggers share
    levels = [handler.level for handler in handlers]
    for handler in handlers:
        handler.setLevel(logging.CRITICAL + 1)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        for handler, level in zip(handlers, levels, strict=True):
            handler.setLevel(level)
