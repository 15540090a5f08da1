# SPDX-License-Identifier: MIT
"""The simulated cell forgets clients, and stops when it is left."""

import time

from support.cell_twins import twin


def test_a_cell_that_forgot_its_client_is_asked_again_and_the_gap_is_counted(take):
    with twin() as (cell, stream), stream:
        take(stream, 1000)
        cell._client = None  # as after a loss of power
        while stream.read(0.2):
            pass
        take(stream, 1)
    assert stream.counters.reconnected == 1
    assert stream.counters.restarted == 1


def test_leaving_stops_the_cell(take, wait_until):
    with twin() as (cell, stream):
        with stream:
            take(stream, 1)
        wait_until(lambda: cell._client is None)
        sent = cell.sent
        time.sleep(0.05)
        assert cell.sent == sent
