# SPDX-License-Identifier: MIT
"""Records of the RDT protocol are whole or damaged; the configuration page of a cell."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.errors import ProtocolError
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.rdt import (
    RECORD,
    describe_status,
    parse_configuration,
)
from support.cell_twins import PAGE, PROFILE, OneRead


@given(st.binary(max_size=80))
def test_any_datagram_is_whole_records_or_damaged(datagram):
    stream = NetFtCell(OneRead(datagram), profile=PROFILE)
    samples = stream.read(0.0)
    whole = len(datagram) in (RECORD.size, 2 * RECORD.size)
    assert bool(samples) == whole
    assert stream.counters.damaged == (not whole)


@given(st.integers(0, 2**32 - 1))
def test_every_status_but_zero_is_spelled_out(status):
    if status & ~(1 << 31):
        assert describe_status(status)


def test_a_configuration_page_gives_counts_in_newtons():
    assert parse_configuration(PAGE).counts_per_force == 1e6
    assert parse_configuration(PAGE).rate == 7000
    kilo = parse_configuration(PAGE.replace(b">N<", b">kN<"))
    assert kilo.counts_per_force == pytest.approx(1e3)


@pytest.mark.parametrize(
    ("page", "said"),
    [
        (b"", "no <cfgcpf>"),
        (PAGE.replace(b">N<", b">stone<"), "force unit is 'stone'"),
        (PAGE.replace(b"<cfgcpf>1000000", b"<cfgcpf>0"), "above 0"),
        (PAGE.replace(b"<cfgcpf>1000000", b"<cfgcpf>many"), "'many'"),
    ],
)
def test_a_page_of_something_else_is_refused(page, said):
    with pytest.raises(ProtocolError, match=said):
        parse_configuration(page)


@given(st.binary(max_size=300))
def test_any_page_is_a_configuration_or_a_protocol_error(page):
    with pytest.raises(ProtocolError):
        parse_configuration(page)
