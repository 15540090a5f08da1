# SPDX-License-Identifier: MIT
"""Signals ask for stops, a repeated Ctrl-C for harder ones."""

import os
import signal

from rig.experiment.signal_stops import signal_stops
from rig.safety import StopCategory, StopSwitch


def test_ctrl_c_asks_for_a_softer_stop_first():
    switch = StopSwitch()
    before = signal.getsignal(signal.SIGINT)
    with signal_stops(switch):
        found = []
        for _ in range(4):
            os.kill(os.getpid(), signal.SIGINT)
            found.append(switch.pending.category)
    assert found == [*StopCategory, StopCategory.EMERGENCY]
    assert signal.getsignal(signal.SIGINT) is before


def test_sigterm_asks_for_a_safe_stop():
    switch = StopSwitch()
    with signal_stops(switch):
        os.kill(os.getpid(), signal.SIGTERM)
    assert (switch.pending.category, switch.pending.reason) == (StopCategory.SAFE, "SIGTERM")
