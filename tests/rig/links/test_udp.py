# SPDX-License-Identifier: MIT
"""Datagrams: addresses, and silence within its limit."""

import time

import pytest

from rig.errors import LinkError
from rig.links.udp import UdpLink


def test_a_name_without_address_is_an_error_that_names_it():
    with pytest.raises(LinkError, match="no such host"):
        UdpLink("no such host", 1).open()


def test_nobody_at_a_udp_port_is_silence_within_the_limit():
    link = UdpLink("127.0.0.1", 9)
    link.open()
    link.write(b"hello")
    began = time.monotonic()
    assert link.read(0.1) == []
    assert time.monotonic() - began < 0.3
    link.close()
