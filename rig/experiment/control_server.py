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
from collections.abc import Generator
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
"""Number of connections; for a further one the oldest is closed."""
MOST_NEW: Final = 8
"""Number of connections that are accepted in a turn; a run has other things to do."""
MOST_WAITING: Final = 64
"""Number of connections that the system holds until they are accepted."""
TURN: Final = 0.02
"""Interval between the turns in which each client is looked at [s]."""
WRONG_TOKEN: Final = "error: wrong token; the token of this run is in its file control.json"  # noqa: S105


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
        self._talks: list[Generator[bool, None, None]] = []
        self._held = contextlib.ExitStack()

    def __enter__(self) -> Self:
        with contextlib.ExitStack() as held:
            listener = socket.create_server(("127.0.0.1", 0), backlog=MOST_WAITING)
            held.enter_context(listener)
            listener.setblocking(False)
            self.port = listener.getsockname()[1]
            held.callback(lambda: [talk.close() for talk in self._talks])
            turn = partial(self._take_turn, listener)
            thread = repeating(turn, every=TURN, name="control socket", control=self._control)
            held.enter_context(thread)
            self._held = held.pop_all()
        return self

    def __exit__(self, *exception: object) -> None:
        self._held.close()

    def _take_turn(self, listener: socket.socket) -> None:
        """Accept new clients, close the connections of the oldest, and attend to the others."""
        with contextlib.suppress(OSError):  # no other waits, it is gone, or no descriptor is free
            for _ in range(MOST_NEW):
                self._talks.append(self._talk(listener.accept()[0]))
        for talk in self._talks[:-MOST_CLIENTS]:
            talk.close()
        self._talks = [talk for talk in self._talks[-MOST_CLIENTS:] if next(talk, False)]

    def _talk(self, link: socket.socket) -> Generator[bool, None, None]:
        """Answer the lines of a client, yielding True in each turn until the connection is closed.

        The end of the connection ends a line, too.
        """
        until, received = time.monotonic() + TOKEN_TIMEOUT, b""
        with link, contextlib.suppress(OSError):
            link.setblocking(False)
            while time.monotonic() < until:
                try:
                    data = link.recv(LONGEST_LINE)
                except BlockingIOError:
                    yield True
                    continue
                lines = (received + data).split(b"\n")
                received = lines.pop() if data else b""
                for line in filter(None, lines):
                    token, _, command = line.decode("utf-8", "replace").strip().partition(" ")
                    known = hmac.compare_digest(token.encode(), self.token.encode())
                    link.sendall(f"{self._reply(command) if known else WRONG_TOKEN}\n".encode())
                    if not known:
                        return
                    until = time.monotonic() + IDLE_TIMEOUT
                if not data or len(received) >= LONGEST_LINE:
                    return
                yield True

    def _reply(self, command: str) -> str:
        """Execute a command and return the reply: `ok ...`, or `error: ...` for an invalid one."""
        try:
            return f"ok {self._control.execute(command, who='socket')}"
        except ProtocolError as problem:
            return f"error: {problem}"


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
