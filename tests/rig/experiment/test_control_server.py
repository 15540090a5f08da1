# SPDX-License-Identifier: MIT
"""A run is commanded over a socket of this machine, by who knows the token."""

import socket
import time
from contextlib import ExitStack

import pytest

from rig.errors import LinkError, ProtocolError
from rig.experiment.control import LONGEST_NOTE, Control
from rig.experiment.control_server import MOST_CLIENTS, ControlServer, send_command
from rig.safety import StopCategory


def test_the_socket_commands_the_run():
    control = Control()
    with ControlServer(control) as server:

        def say(command):
            return send_command(server.port, server.token, command)

        assert say("status") == "not started"
        say("soft")
        assert control.stop.pending.category is StopCategory.SOFT
        say("resume")
        assert control.stop.pending is None
        say("emergency smoke")
        assert control.stop.pending.reason == "smoke"
        say("resume")
        assert control.stop.latched


def test_who_does_not_know_the_token_commands_nothing():
    control = Control()
    with ControlServer(control) as server:
        with pytest.raises(ProtocolError, match="wrong token"):
            send_command(server.port, "guess", "soft")
        with pytest.raises(ProtocolError, match="wrong token"):
            send_command(server.port, "POST", "/ HTTP/1.1")
    assert control.stop.pending is None


def connect(server, first=b""):
    link = socket.create_connection(("127.0.0.1", server.port), timeout=10)
    link.sendall(first)
    return link


def is_closed(link):
    """Return whether the other end closes a connection, or has closed it."""
    try:
        return link.recv(1) == b""
    except ConnectionResetError:
        return True


def test_a_client_with_the_token_stays_connected_and_the_end_of_its_connection_ends_a_line():
    control = Control()
    with ControlServer(control) as server, connect(server) as link, link.makefile("rb") as answers:
        for command in (b"status", b"note a\n", b"nonsense", b"note b"):
            link.sendall(server.token.encode() + b" " + command + b"\n" * (command != b"note b"))
        link.shutdown(socket.SHUT_WR)
        said = answers.read().splitlines()
    assert [line.split()[0] for line in said] == [b"ok", b"ok", b"error:", b"ok"]
    assert [note.text for note in control.take_notes()] == ["socket: a", "socket: b"]


@pytest.mark.parametrize(
    "first", [b"", b"soft", b"soft\nsafe\n", b"x" * 100_000, b"\n" * 9, b"\xff\n"]
)
def test_who_does_not_show_the_token_soon_is_disconnected(first):
    control = Control()
    with ControlServer(control) as server, connect(server, first) as link:
        while not is_closed(link):
            pass
        assert control.stop.pending is None


def test_a_client_that_trickles_is_disconnected():
    def trickle(link):
        for _ in range(1000):
            link.sendall(b"x")
            time.sleep(0.01)

    with ControlServer(Control()) as server, connect(server) as link, pytest.raises(OSError):
        trickle(link)


def test_of_many_clients_the_oldest_are_disconnected_and_the_next_is_served():
    control = Control()
    with ControlServer(control) as server, ExitStack() as stack:
        idle = [stack.enter_context(connect(server)) for _ in range(3 * MOST_CLIENTS)]
        assert send_command(server.port, server.token, "pause") == "done"
        assert all(is_closed(link) for link in idle)
    assert control.paused


def test_a_fault_of_the_server_is_a_failed_part_of_the_run(monkeypatch):
    control = Control()
    monkeypatch.setattr(control, "execute", lambda line, *, who: 1 / 0)
    with ControlServer(control) as server, pytest.raises((LinkError, ProtocolError)):
        send_command(server.port, server.token, "status", timeout=0.3)
    assert "control socket failed: ZeroDivisionError" in str(control.failure)


def test_bytes_of_a_foreign_encoding_reach_the_run_as_escapes():
    control = Control()
    with ControlServer(control) as server:
        assert send_command(server.port, server.token, "note caf\udce9") == "done"
    assert [note.text for note in control.take_notes()] == [r"socket: caf\udce9"]


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("note a\nemergency", "found 2 lines; expected one"),
        ("note a\r\nb\n", "found 2 lines; expected one"),
        (
            "note " + "x" * LONGEST_NOTE,
            f"{LONGEST_NOTE + 5} characters; at most {LONGEST_NOTE}",
        ),
    ],
)
def test_a_command_that_would_be_cut_is_refused(command, message):
    control = Control()
    with ControlServer(control) as server, pytest.raises(ProtocolError, match=message):
        send_command(server.port, server.token, command)
    assert (list(control.take_notes()), control.stop.pending) == ([], None)


def test_the_longest_command_arrives_whole():
    control = Control()
    text = "\U0001f916" * (LONGEST_NOTE - len("note "))
    with ControlServer(control) as server:
        assert send_command(server.port, server.token, f"note {text}\n") == "done"
    assert [note.text for note in control.take_notes()] == [f"socket: {text}"]


def test_only_this_machine_is_listened_to():
    with ControlServer(Control()) as server, socket.socket() as other:
        other.settimeout(1.0)
        with pytest.raises(OSError):
            other.bind(("127.0.0.1", server.port))


def test_a_run_that_is_over_does_not_answer():
    with ControlServer(Control()) as server:
        port = server.port
    with pytest.raises(LinkError, match="it has ended, or is too busy"):
        send_command(port, "x", "status")
