# SPDX-License-Identifier: MIT
"""Local control socket of a run: one command per line, from this machine only, with a token.

The token prevents other users of the machine, and web pages that connect to loopback ports, from
commanding motors. Any process that can read the run's files can command the run.
"""

import contextlib
import hmac
import secrets
import socket
import socketserver
import sys
import threading
from functools import partial
from typing import Final, Self

from rig.errors import LinkError, PartFailed, ProtocolError
from rig.experiment.control import LONGEST_NOTE, Control
from rig.experiment.supervision import start_thread

LONGEST_LINE: Final = 4 * LONGEST_NOTE + 256
"""Longest line, with a token and a command of `LONGEST_NOTE` characters [bytes]."""
IDLE_TIMEOUT: Final = 600.0
"""Silence after which a client is disconnected [s]."""
JOIN_TIMEOUT: Final = 2.0


class ControlServer:
    """TCP server that passes commands to a run's mailbox, at a loopback port; a context manager.

    A line is `TOKEN COMMAND`; the answer is a line that begins with `ok` or `error`.

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
        self._server: socketserver.ThreadingTCPServer | None = None
        self._thread: threading.Thread | None = None

    def answer(self, line: str) -> str:
        """Execute the command of one line `TOKEN COMMAND` and return the answer.

        The answer is `ok ...`, or `error: ...` for a wrong token or an invalid command.
        """
        token, _, command = line.strip().partition(" ")
        if not hmac.compare_digest(token.encode(), self.token.encode()):
            return "error: wrong token; the token of this run is in its file control.json"
        try:
            return f"ok {self._control.execute(command, who='socket')}"
        except ProtocolError as problem:
            return f"error: {problem}"

    def __enter__(self) -> Self:
        answer = self.answer

        class Handler(socketserver.StreamRequestHandler):
            """Connection of one client: answers line by line until it closes or is silent."""

            timeout = IDLE_TIMEOUT

            def handle(self) -> None:
                """Answer the client's lines; an answer that cannot be sent ends the connection."""
                with contextlib.suppress(OSError):  # disconnected, or silent for too long
                    while line := self.rfile.readline(LONGEST_LINE):
                        reply = answer(line.decode("utf-8", "replace"))
                        self.wfile.write(f"{reply}\n".encode())

        control = self._control

        class Server(socketserver.ThreadingTCPServer):
            """Server whose connections end with the program, each in a thread of its own."""

            daemon_threads = True
            block_on_close = False

            def handle_error(self, request: object, client_address: object) -> None:
                """Report an exception in a connection to the run, which then makes a safe stop."""
                del request, client_address
                error = sys.exception()
                control.fail("control socket", error or RuntimeError("unknown"))

        self._server = Server(("127.0.0.1", 0), Handler)
        self.port = self._server.server_address[1]
        try:
            self._thread = start_thread(
                partial(self._server.serve_forever, 0.05), name="control socket", control=control
            )
        except PartFailed:
            self._server.server_close()
            raise
        return self

    def __exit__(self, *exception: object) -> None:
        if self._server is not None and self._thread is not None:
            self._server.shutdown()
            self._server.server_close()
            self._thread.join(JOIN_TIMEOUT)


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
