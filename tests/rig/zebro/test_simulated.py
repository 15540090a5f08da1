# SPDX-License-Identifier: MIT
"""Simulated robots restart and report their own counts."""

import numpy as np

from rig.device import iterate
from rig.links.faults import Faults
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile
from support.leg_twins import GAIT, SERIAL, stream_of


def test_a_robot_that_restarts_is_noticed_and_read_on():
    stream, clock, twin = stream_of(SERIAL, Faults())
    with stream:
        before = list(iterate(stream, duration=5.0, clock=clock))
        twin.legs.restart()
        after = list(iterate(stream, duration=1.0, clock=clock))
    assert stream.counters.restarted == 1
    assert len(after) >= 99
    assert before[-1].sequence < after[0].sequence


def test_a_polled_robot_waits_for_the_rest_of_a_request_and_discards_unknown_bytes():
    profile = load_leg_profile("zebrobus-uart")
    registers = profile.registers
    twin = robot_twin(profile, GAIT, faults=Faults(), rng=np.random.default_rng(0))
    request = bytes((registers.read_command, registers.positions[0], 12))
    assert twin.poll(0.0, b"\x00" + request[:2]) == b""
    answer = twin.poll(0.0, request[2:])
    assert len(answer) == 12
    assert twin.poll(0.0, request + request) == 2 * answer
    assert twin.poll(1.0, request) != answer  # the legs have turned by 4 rad
