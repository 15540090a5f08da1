# SPDX-License-Identifier: MIT
"""The simulated cell forgets clients, and serves its configuration."""

import time

import numpy as np

from rig.slip_rig.decode import decode_forces
from support.cell_twins import PROFILE, twin


def test_bias_makes_the_present_reading_zero(take):
    with twin() as (_, stream), stream:
        take(stream, 1)
        stream.bias()
        take(stream, 3000)  # what was under way when the cell took its zero
        forces = decode_forces(PROFILE, take(stream, 1))
    assert np.abs(forces.normal).max() < 1e-5


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
