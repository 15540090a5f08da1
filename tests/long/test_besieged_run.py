# SPDX-License-Identifier: MIT
"""An emergency stop reaches a run within half a second, however many clients besiege it."""

import json
import subprocess
import sys
import time

import pytest

from benchmarks.faults.stop_faults import ROWS
from benchmarks.faults.stop_latency import LIMIT, bring_to_speed, write_plan, write_profile
from benchmarks.faults.stop_latency_lab import Lab
from benchmarks.faults.stop_latency_twin import twin_process
from support.floods import flooded
from zebro_lab.experiment.journal import read_journal
from zebro_lab.experiment.say_stage import CONTROL_FILE

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(sys.platform != "linux", reason="all processes must share one clock"),
]
UNHARMED = 5.0
"""How long a besieged run goes on before it is stopped [s]."""
SAY = """
import sys, time
from pathlib import Path
from zebro_lab.experiment.say_stage import command_run
print("ready", flush=True)
sys.stdin.readline()
print(time.monotonic(), flush=True)
print(command_run(Path(sys.argv[1]), "emergency smoke"), flush=True)
"""


@pytest.mark.parametrize("socket_is_dead", [False, True])
@pytest.mark.parametrize("rig", ["board", "drives"])
def test_a_besieged_run_is_unharmed_and_stops_within_half_a_second(tmp_path, rig, socket_is_dead):
    row = next(row for row in ROWS if row.rig == rig and row.way != "fill")
    data, plan = tmp_path / "data", tmp_path / "plan.toml"
    write_plan(plan, row)
    with twin_process(rig) as twin:
        address = write_profile(tmp_path / "rig.toml", twin)
        lab = Lab(["rig", "run", str(plan), "--rig", address, "--data", str(data)])
        say = subprocess.Popen(
            [sys.executable, "-c", SAY, str(data)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            text=True,
        )  # fmt: skip
        try:
            bring_to_speed(lab, twin, data)
            assert say.stdout.readline() == "ready\n"
            began = time.monotonic()
            port = json.loads((data / CONTROL_FILE).read_text())["port"]
            with flooded(port, idle=500, talking=50, processes=4):
                lab.watch(lambda: False, UNHARMED)
                assert lab.code is None, lab.last_lines
                if socket_is_dead:
                    (data / CONTROL_FILE).unlink()
                said, _ = say.communicate("\n", timeout=30)
                lab.wait(30.0)
            at, reply = said.split("\n", 1)
            assert "emergency stop by emergency-latch" in reply
            stops = [when for when, _, both in twin.seen().commands if both and when > began]
            print(f"{rig}: {1e3 * (stops[0] - float(at)):.0f} ms; {reply.strip()}")  # noqa: T201
            assert 0 < stops[0] - float(at) <= LIMIT
            assert (lab.code, read_journal(data).latched) == (130, "emergency stop: smoke")
        finally:
            say.kill()
            say.communicate()
            lab.close()
