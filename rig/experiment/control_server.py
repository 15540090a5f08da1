# SPDX-License-Identifier: MIT
"""Local control socket of a run: one command per line, from this machine only, with a token.

The token prevents other users of the machine, and web pages that connect to loopback ports, from
commanding motors. Any process that can read the run's files can command the run.
"""

import contextlib
import hmac
import secrets
import socket
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Final, Self

from rig.errors import LinkError, ProtocolError
from rig.experiment.control import LONGEST_NOTE, Control
from rig.experiment.supervision import repeating

LONGEST_LINE: Final = 4 * LONGEST_NOTE + 256
"""Longest line, with a token and a command of `LONGEST_NOTE` characters [bytes]."""
IDLE_TIMEOUT: Final = 600.0
"""Silence after which a client with the token is disconnected [s]."""
TOKEN_TIMEOUT: Final = 1.0
"""Time within which a client must have sent a line with the token [s]."""
MOST_CLIENTS: Final = 16
"""Number of connections; for a further one the oldest is closed that has not shown the token."""
MOST_NEW: Final = 8
"""Number of connections that are accepted in a turn; a run has other things to do."""
MOST_WAITING: Final = 64
"""Number of connections that the system holds until they are accepted."""
TURN: Final = 0.02
"""Interval between the turns in which each client is looked at [s]."""


@dataclass
class _Client:
    """Connection of one client.

    Attributes:
        link: The connection, which does not block.
        until: Time at which it is closed, unless a line with the token comes before [s].
        known: Whether it has shown the token.
        received: Beginning of a line.
    """

    link: socket.socket
    until: float
    known: bool = False
    received: bytes = b""


class ControlServer:
    """TCP server that passes commands to a run's mailbox, at a loopback port; a context manager.

    A line is `TOKEN COMMAND`; the answer is a line that begins with `ok` or `error`. One thread
    serves all clients in turns, so that those without the token, however many, take neither
    descriptors nor more than a few percent of a processor's time from the run.

    Args:
        control: Mailbox of the run.

    Attributes:
        port: Port assigned by the system; 0 until the server is entered.
        token: Token with which each line must begin.
    """

    def __init__(self, control: Control) -> None:
        self.port = 0
        self.token = secrets.token_urlsafe(16)
        self._control = control
        self._clients: list[_Client] = []
        self._held = contextlib.ExitStack()

    def __enter__(self) -> Self:
        with contextlib.ExitStack() as held:
            listener = socket.create_server(("127.0.0.1", 0), backlog=MOST_WAITING)
            held.enter_context(listener)
            listener.setblocking(False)
            self.port = listener.getsockname()[1]
            held.callback(lambda: [client.link.close() for client in self._clients])
            turn = partial(self._take_turn, listener)
            thread = repeating(turn, every=TURN, name="control socket", control=self._control)
            held.enter_context(thread)
            self._held = held.pop_all()
        return self

    def __exit__(self, *exception: object) -> None:
        self._held.close()

    def _take_turn(self, listener: socket.socket) -> None:
        """Accept new clients, in the place of the oldest without the token, and attend to all."""
        clients = [*self._clients, *_accepted(listener)]
        clients.sort(key=lambda client: client.known)  # the first have waited longest
        for client in clients[:-MOST_CLIENTS]:
            client.link.close()
        self._clients = clients[-MOST_CLIENTS:]
        self._clients = [client for client in self._clients if self._attend(client)]

    def _attend(self, client: _Client) -> bool:
        """Answer the lines of a client that have arrived; close the connection or return True.

        The end of the connection ends a line, too.
        """
        kept = True
        try:
            data = client.link.recv(LONGEST_LINE)
            lines = (client.received + data).split(b"\n")
            client.received = lines.pop() if data else b""
            known = all(self._answer(client, line) for line in lines if line)
            kept = known and len(data) > 0 and len(client.received) < LONGEST_LINE
        except BlockingIOError:
            pass
        except OSError:
            kept = False
        if kept and time.monotonic() < client.until:
            return True
        client.link.close()
        return False

    def _answer(self, client: _Client, line: bytes) -> bool:
        """Execute the command of a line `TOKEN COMMAND`; return whether the token was right."""
        token, _, command = line.decode("utf-8", "replace").strip().partition(" ")
        client.known = hmac.compare_digest(token.encode(), self.token.encode())
        client.until = time.monotonic() + IDLE_TIMEOUT
        reply = "error: wrong token; the token of this run is in its file control.json"
        if client.known:
            try:
                reply = f"ok {self._control.execute(command, who='socket')}"
            except ProtocolError as problem:
                reply = f"error: {problem}"
        client.link.sendall(f"{reply}\n".encode())
        return client.known


def _accepted(listener: socket.socket) -> Iterator[_Client]:
    """Accept and yield the clients that wait, at most `MOST_NEW`."""
    with contextlib.suppress(OSError):  # there is no other, it is gone, or no descriptor is free
        for _ in range(MOST_NEW):
            link, _ = listener.accept()
            link.setblocking(False)
            yield _Client(link, time.monotonic() + TOKEN_TIMEOUT)


def send_command(port: int, token: str, command: str, *, timeout: float = 2.0) -> str:
    """Send a command to a running experiment on this machine, and return the answer.

    Args:
        port: Port of the run's control socket.
        token: Token of the run.
        command: One of the commands of `Control.execute`.
        timeout: Longest wait for the connection, and for the answer [s].

    Returns:
        The answer without its `ok`.

    Raises:
        LinkError: No run listens at the port, or a busy run does not answer within `timeout`.
        ProtocolError: The run rejected the command or closed the connection, or the command is
            not one line of at most `LONGEST_NOTE` characters.
    """
    line = f"{token} {_checked_command(command)}\n"
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=timeout) as link:
            link.sendall(line.encode())
            with link.makefile("r", encoding="utf-8", errors="replace") as lines:
                reply = lines.readline(LONGEST_LINE).strip()
    except OSError as problem:
        raise LinkError(
            f"no experiment answers at port {port} of this machine: {problem}; it has ended, or is "
            "too busy: send the command again"
        ) from problem
    if not reply.startswith("ok"):
        raise ProtocolError(reply.removeprefix("error: ") or "the run closed the link unanswered")
    return reply.removeprefix("ok").strip()


def _checked_command(command: str) -> str:
    """Return a command stripped and with unpaired surrogates escaped.

    Raises:
        ProtocolError: The command has several lines or more than `LONGEST_NOTE` characters.
    """
    text = command.strip().encode("utf-8", "backslashreplace").decode("utf-8")
    lines = len(text.splitlines())
    if lines > 1:
        raise ProtocolError(f"found {lines} lines; expected one: send one command at a time")
    if len(text) > LONGEST_NOTE:
        raise ProtocolError(
            f"the command has {len(text)} characters; at most {LONGEST_NOTE} are allowed: shorten "
            "it, or send several notes"
        )
    return text
