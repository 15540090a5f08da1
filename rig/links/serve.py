# SPDX-License-Identifier: MIT
"""Serve twins in real time at a pseudo-terminal or a loopback socket that any program can open."""

import contextlib
import os
import select
import socket
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Final, Self

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import LinkError
from rig.links.byte_link import ByteTwin

TICK: Final = 0.002
"""Interval at which a served twin is polled [s]."""
JOIN_TIMEOUT: Final = 2.0
"""Longest wait for the end of the thread [s]."""


class Ticker:
    """Thread that calls a function periodically, every `TICK`, until the context is left.

    Args:
        tick: Function to call with the host time [s].
        clock: Host time.

    Attributes:
        failure: Exception that the function raised, which ends the calls; None without one.
    """

    def __init__(self, tick: Callable[[float], None], *, clock: Clock = SYSTEM_CLOCK) -> None:
        self.failure: BaseException | None = None
        self._tick = tick
        self._clock = clock
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True, name="twin")

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self._done.set()
        self._thread.join(JOIN_TIMEOUT)

    def _run(self) -> None:
        """Call the function every `TICK` until the end, or until it raises."""
        try:
            while not self._done.wait(TICK):
                self._tick(self._clock.now())
        except BaseException as failure:  # noqa: BLE001, RUF100 - kept for the owner to see
            self.failure = failure


class _Terminal:
    """Pseudo-terminal with a name that stays the same when it is unplugged and plugged in."""

    def __init__(self, link: Path) -> None:
        import tty

        self._master, self._slave = os.openpty()  # the open slave keeps the master from hanging up
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(self._slave))
        self._link = link
        self.port = str(link)

    def exchange(self, data: bytes) -> bytes:
        """Send bytes to the program at the port, and return those that it has sent.

        Bytes that do not fit into the terminal's buffer are dropped.
        """
        with contextlib.suppress(BlockingIOError):  # a full buffer drops bytes, as a UART does
            os.write(self._master, data)
        try:
            return os.read(self._master, 65_536)
        except BlockingIOError:
            return b""

    def close(self) -> None:
        """Remove the name of the port and close both ends of the pseudo-terminal."""
        self._link.unlink(missing_ok=True)
        os.close(self._slave)
        os.close(self._master)


class _Socket:
    """Listening socket on the loopback interface that serves one client at a time."""

    def __init__(self, port: int = 0) -> None:
        self._listener = socket.create_server(("127.0.0.1", port))
        self._listener.setblocking(False)
        self._client: socket.socket | None = None
        self.number: int = self._listener.getsockname()[1]
        self.port = f"socket://127.0.0.1:{self.number}"

    def exchange(self, data: bytes) -> bytes:
        """Send bytes to the client, and return those that it has sent; none without a client."""
        if self._client is None and not self._accept():
            return b""
        try:
            return self._through(data)
        except OSError:
            self._drop()
            return b""

    def close(self) -> None:
        """Close the connection to the client, if there is one, and the listening socket."""
        self._drop()
        self._listener.close()

    def _accept(self) -> bool:
        """Accept a waiting client; return whether there was one."""
        try:
            self._client, _ = self._listener.accept()
        except BlockingIOError:
            return False
        self._client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._client.settimeout(1.0)
        return True

    def _through(self, data: bytes) -> bytes:
        """Send bytes to the client and return what it has sent; drop a client that has closed."""
        client = self._client
        if client is None:
            return b""
        client.sendall(data)
        if not select.select([client], [], [], 0)[0]:
            return b""
        received = client.recv(65_536)
        if not received:
            self._drop()
        return received

    def _drop(self) -> None:
        """Close the connection to the client, if there is one."""
        client, self._client = self._client, None
        if client is not None:
            client.close()


class PortServer:
    """Serves a byte twin at a port: a context manager.

    Args:
        twin: Simulated device, polled every `TICK` while the server is entered.
        as_socket: Listen on `socket://` of the loopback interface instead of a pseudo-terminal;
            always so on Windows, which has none.
        clock: Host time.

    Attributes:
        port: Name of the port that a driver, or any program, opens; empty until entered.
    """

    def __init__(
        self, twin: ByteTwin, *, as_socket: bool = False, clock: Clock = SYSTEM_CLOCK
    ) -> None:
        self.port = ""
        self._twin = twin
        self._as_socket = as_socket or sys.platform == "win32"
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._number = 0
        self._end: _Terminal | _Socket | None = None
        self._lock = threading.Lock()
        self._received = b""
        self._ticker = Ticker(self._tick, clock=clock)

    @property
    def failure(self) -> BaseException | None:
        """Exception that the twin or its port raised, which ends the polling; None without one."""
        return self._ticker.failure

    def unplug(self) -> None:
        """Remove the port while the twin keeps running; its bytes are then lost."""
        with self._lock:
            end, self._end = self._end, None
            if end is not None:
                end.close()

    def plug_in(self) -> None:
        """Create the port, after `unplug` again under the same name.

        Raises:
            LinkError: The system provides no port.
        """
        with self._lock:
            try:
                self._end = self._make()
            except OSError as problem:
                raise LinkError(f"cannot create a port for a simulation: {problem}") from problem
            self.port = self._end.port

    def __enter__(self) -> Self:
        self.plug_in()
        self._ticker.__enter__()
        return self

    def __exit__(self, *exception: object) -> None:
        self._ticker.__exit__(*exception)
        self.unplug()
        if self._folder is not None:
            self._folder.cleanup()

    def _make(self) -> _Terminal | _Socket:
        """Create the port, with the name or number that it had before, if any."""
        if self._as_socket:
            end = _Socket(self._number)
            self._number = end.number
            return end
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="zebro-lab-twin-")
        return _Terminal(Path(self._folder.name) / "port")

    def _tick(self, now: float) -> None:
        """Poll the twin with the bytes last received, and exchange bytes with the port."""
        data = self._twin.poll(now, self._received)
        with self._lock:
            self._received = self._end.exchange(data) if self._end is not None else b""
