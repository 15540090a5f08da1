# SPDX-License-Identifier: MIT
"""Clients that besiege a port of this machine: idle ones, and ones that write garbage."""

import contextlib
import selectors
import socket
import subprocess
import sys
import time
from collections.abc import Iterator

PAUSE = 0.01
"""Between two rounds of a process's clients: an attacker wants the port, not all of the processor's
time, which the system would share among all programs [s]."""


@contextlib.contextmanager
def flooded(port: int, *, idle: int, talking: int, processes: int = 1) -> Iterator[None]:
    """Besiege a port while the body runs; clients that are disconnected connect again.

    Args:
        port: The port.
        idle: Number of clients that say nothing, of each process.
        talking: Number of clients that write garbage, of each process.
        processes: Number of processes.
    """
    command = [sys.executable, __file__, str(port), str(idle), str(talking)]
    floods = [subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(processes)]
    try:
        for flood in floods:
            assert flood.stdout is not None
            assert flood.stdout.readline() == b"flooding\n"
        yield
    finally:
        for flood in floods:
            flood.kill()
            flood.communicate()


def _connected(port: int) -> socket.socket:
    link = socket.socket()
    link.setblocking(False)
    link.connect_ex(("127.0.0.1", port))
    return link


def _flood(port: int, idle: int, talking: int) -> None:
    if sys.platform != "win32":
        import resource

        most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    closed = selectors.DefaultSelector()
    talkers = [_connected(port) for _ in range(talking)]
    for link in [*talkers, *(_connected(port) for _ in range(idle))]:
        closed.register(link, selectors.EVENT_READ)
    print("flooding", flush=True)  # noqa: T201 - for the process that started this one
    while True:
        for link in talkers:
            with contextlib.suppress(OSError):
                link.send(b"garbage " * 100 + b"\n")
        for key, _ in closed.select(0):
            link = key.fileobj
            assert isinstance(link, socket.socket)
            with contextlib.suppress(OSError):
                if link.recv(10_000):
                    continue
            again = _connected(port)
            closed.unregister(link)
            closed.register(again, selectors.EVENT_READ)
            if link in talkers:
                talkers[talkers.index(link)] = again
            link.close()
        time.sleep(PAUSE)


if __name__ == "__main__":
    _flood(*map(int, sys.argv[1:]))
