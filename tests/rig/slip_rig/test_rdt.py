# SPDX-License-Identifier: MIT
"""Records of the RDT protocol are whole or damaged."""

from hypothesis import given
from hypothesis import strategies as st

from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.rdt import (
    RECORD,
    describe_status,
)
from support.cell_twins import PROFILE, OneRead


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
