# SPDX-License-Identifier: MIT
"""Addresses of schedulers are parsed, and unencrypted ones stay within a network of one's own."""

import socket

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.workers.address import parse_address, require_own_network


@pytest.mark.parametrize(
    ("text", "host"),
    [
        ("tcp://127.0.0.1:8786", "127.0.0.1"),
        ("tls://lab-server:1", "lab-server"),
        ("tcp://[::1]:8786", "::1"),
    ],
)
def test_an_address_has_protocol_host_and_port(text, host):
    found = parse_address(text)
    assert (found.protocol, found.host, found.text) == (text[:3], host, text)


@pytest.mark.parametrize(
    "text",
    ["", "127.0.0.1:8786", "http://a:1", "tcp://a", "tcp://a:0", "tcp://a:70000", "tcp://:8"],
)
def test_another_form_is_wrong_usage_with_an_example(text):
    with pytest.raises(SettingsError, match=r"^--scheduler: found '.*tcp://127\.0\.0\.1:8786"):
        parse_address(text)


@pytest.mark.parametrize("host", ["127.0.0.1", "192.168.1.7", "10.0.0.1", "[::1]", "[fe80::1]"])
def test_this_machine_and_private_networks_are_ones_own(host):
    require_own_network(parse_address(f"tcp://{host}:8786"))


@pytest.mark.parametrize("host", ["8.8.8.8", "[2001:4860:4860::8888]"])
def test_others_need_tls(host):
    with pytest.raises(SettingsError, match="use tls://"):
        require_own_network(parse_address(f"tcp://{host}:8786"))
    require_own_network(parse_address(f"tls://{host}:8786"))


def test_an_unknown_host_is_named(monkeypatch):
    def unknown(*_, **__):
        raise socket.gaierror("name unknown")

    monkeypatch.setattr(socket, "getaddrinfo", unknown)
    with pytest.raises(SettingsError, match="the host 'lab' is unknown"):
        require_own_network(parse_address("tcp://lab:8786"))
