# SPDX-License-Identifier: MIT
"""A simulated device at a port that any program can open."""

import re
import signal

import pytest

from rig.clock import ManualClock
from support.commands import started
from zebro_lab.recording.simulate_command import wait_until


def test_a_twin_prints_its_port_and_any_program_can_record_it(run_command, tmp_path):
    with started("sim", "zebro", "--socket", "--drop", "0.1") as twin:
        line = twin.stdout.readline()
        assert line.startswith("SIMULATED robot (sim:zebro), profile zebro-100-serial: socket://")
        port = line.split()[-1]
        code, out, _ = run_command(
            "record", "--zebro", f"zebro-100-serial@{port}", "--duration", 1.0, "--label", "x",
            "--data", tmp_path,
        )  # fmt: skip
        twin.send_signal(signal.SIGTERM)
        assert twin.wait(20) == 0
    assert code == 0
    received, lost = map(int, re.search(r"legs: (\d+) samples received, (\d+) lost", out).groups())
    assert received > 50
    assert 0 < lost < 0.3 * received


@pytest.mark.parametrize(("looks", "duration", "expected"), [(3, None, 0.15), (99, 0.5, 0.5)])
def test_a_twin_runs_until_it_is_stopped_or_its_time_is_up(looks, duration, expected):
    clock, asked = ManualClock(), []

    def stop_requested():
        asked.append(None)
        return len(asked) > looks

    wait_until(stop_requested, duration=duration, clock=clock)
    assert clock.now() == pytest.approx(expected, abs=0.051)
