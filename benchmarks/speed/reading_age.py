# SPDX-License-Identifier: MIT
"""How old readings are when the acquiring thread looks at them; prints the table of drivers.md.

python -m benchmarks.speed.reading_age [--ramps N] [--seconds S] [--no-fit] [--can BUS]

BUS is such as socketcan:vcan0.

A twin in a process of its own is driven through ramps by the guarded loop of `rig run`, at its
full rate, while `calibrate-slip` fits in a third process. All clocks are the machine's monotonic
one, so that the true age of each reading is known: the board and the load cell tell when a reading
was taken, and the drives' twin sends the time in place of the position. The age counts from when
the reading was due, so that what the twin itself is late by is in it, though it comes first in turn
where that is allowed. A CAN interface of the kernel
must be up, and nothing but the twin be on it.
"""

import argparse
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

import can
import numpy as np

from rig.backends import RigDevices
from rig.clock import SYSTEM_CLOCK
from rig.device import Sample
from rig.experiment.acquire import GuardedAcquisition
from rig.experiment.bench import Bench, make_bench
from rig.experiment.control import Control
from rig.experiment.plan import RunLimits
from rig.links.can import CanLink
from rig.links.serial import SerialLink
from rig.links.serve import PortServer, Ticker
from rig.links.slcan import SlcanAdapter
from rig.links.udp import UdpLink
from rig.slip_rig.board import RigBoard
from rig.slip_rig.can_simple import ESTIMATES, Command
from rig.slip_rig.drives import DriveBus
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.slip_rig.sweep import SweepPlan
from support.memory_sink import MemorySink
from zebro_lab.experiment.plan_file import read_plan

PROJECT = Path(__file__).parents[2]
TOP_SPEED = 12.0
TURN = 64.0
"""Time sent in place of a position is modulo this: single precision tells 4 us of it [s]."""
WATCHDOG = 1.0
"""Longer than a real one's: a twin held up by the load must not end the measurement [s]."""
FIT_HEAD_START = 10.0
"""Until a fit has read its data and samples [s]."""
NAMES = {"slcan": "SLCAN, drives", "can": "CAN of the kernel, drives", "serial": "serial, board"}


class StampedDrives(SimulatedDrives):
    """Drives that send the time in place of the position."""

    def _send(self, axis, command, data):
        if command == Command.ENCODER_ESTIMATES:
            data = ESTIMATES.pack(time.monotonic() % TURN, ESTIMATES.unpack(data)[1])
        super()._send(axis, command, data)


def serve(link: str, channel: str) -> None:
    """Serve a twin until this process is ended; print where it is and when it was switched on."""
    # It stands for hardware that waits for no processor: first in turn, where that is allowed.
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    rng = np.random.default_rng(0)
    rig = SimulatedRig(
        plan=SweepPlan(), imperfections=TYPICAL_RIG, dynamics=RigDynamics(ripple=0.005), rng=rng
    )
    rig.load = 5.0
    rig.command("leg", 0.0)
    with ExitStack() as stack:
        place = (_serve_board if link == "serial" else _serve_drives)(stack, rig, link, channel)
        while (switched_on := rig._switched_on) is None:
            time.sleep(0.01)
        print(json.dumps(place | {"switched_on": switched_on}), flush=True)
        sys.stdin.read()


def _serve_board(stack: ExitStack, rig: SimulatedRig, link: str, channel: str) -> dict[str, object]:
    del link, channel
    profile = load_rig_profile("rig-board-serial").board
    assert profile is not None
    rng = np.random.default_rng(1)
    twin = SimulatedBoard(rig, profile=profile, watchdog=WATCHDOG, rng=rng)
    return {"port": stack.enter_context(PortServer(twin)).port}


def _serve_drives(
    stack: ExitStack, rig: SimulatedRig, link: str, channel: str
) -> dict[str, object]:
    profile = load_rig_profile("rig-odrive-netft")
    assert profile.drives is not None
    assert profile.load_cell is not None
    if link == "slcan":
        near, far = (
            stack.enter_context(can.Bus(interface="virtual", channel="bench")) for _ in range(2)
        )
        adapter = PortServer(SlcanAdapter(far, source="sim:rig"))
        adapter.plug_in()
        stack.callback(adapter.unplug)
        place, also = f"slcan:{adapter.port}", adapter._tick
    else:
        interface, _, name = channel.partition(":")
        near = stack.enter_context(can.Bus(interface=interface, channel=name))
        place, also = channel, None
    drives = StampedDrives(rig, near, profile=profile.drives, watchdog=WATCHDOG)
    cell = stack.enter_context(
        SimulatedLoadCell(rig, profile=profile.load_cell, rng=np.random.default_rng(1))
    )

    def tick(now: float) -> None:
        drives.poll(now)
        if also is not None:  # in the same thread: two would wait for one another
            also(now)
        cell.poll(now)

    stack.enter_context(Ticker(tick))
    return {"port": place, "host": cell.host, "cell": cell.port}


@contextmanager
def twin_process(link: str, channel: str) -> Iterator[dict[str, object]]:
    """Start a twin in a process of its own; yield where it is."""
    command = [
        sys.executable,
        "-m",
        "benchmarks.speed.reading_age",
        "--serve",
        link,
        "--can",
        channel,
    ]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=PROJECT
    ) as process:
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())
        finally:
            process.kill()


@contextmanager
def fitting(wanted: bool) -> Iterator[None]:
    """Let calibrate-slip fit again and again in a process group of its own."""
    if not wanted:
        yield
        return
    with tempfile.TemporaryDirectory() as folder:
        fit = "from zebro_lab.main import calibrate_slip; calibrate_slip()"
        once = f"{sys.executable} -c '{fit}' datasets/rig-sim --out {folder}/c$((++i))"
        process = subprocess.Popen(
            ["bash", "-c", f"while true; do {once}; done"], cwd=PROJECT, process_group=0,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        try:
            time.sleep(FIT_HEAD_START)
            yield
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def make_devices(place: dict[str, object]) -> RigDevices:
    """Make the real drivers for a twin."""
    port = str(place["port"])
    if "cell" not in place:
        profile = load_rig_profile("rig-board-serial")
        assert profile.board is not None
        link = SerialLink(port, baudrate=profile.board.baudrate, source="sim:rig")
        return RigDevices(
            profile, board=RigBoard(link, profile=profile.board, limits=profile.limits)
        )
    profile = load_rig_profile("rig-odrive-netft")
    assert profile.drives is not None
    assert profile.load_cell is not None
    datagrams = UdpLink(str(place["host"]), int(str(place["cell"])), source="sim:rig")
    return RigDevices(
        profile,
        drives=DriveBus(CanLink(port, source="sim:rig"), profile=profile.drives,
                        limits=profile.limits),
        load_cell=NetFtCell(datagrams, profile=profile.load_cell),
    )  # fmt: skip


def limits(seconds: float) -> RunLimits:
    """Return the thesis plan's limits with a slow ramp, and patient where the load may hold up."""
    plan = read_plan(PROJECT / "examples" / "plan-thesis.toml")
    return replace(
        plan.limits, acceleration=TOP_SPEED / seconds, silence=1.0, reading_age=1.0,
        speed_error_time=1.0,
    )  # fmt: skip


def true_age(sample: Sample, now: float, switched_on: float) -> float:
    """Compute how old a reading is [s]."""
    if sample.device_time is None:
        return (now - sample.counts[0] + TURN / 2) % TURN - TURN / 2
    return now - switched_on - sample.device_time


def ramp_ages(
    bench: Bench, switched_on: float, *, ramps: int, seconds: float
) -> tuple[dict[str, list[float]], dict[str, list[float]]]:
    """Ramp up and down; return the true ages by stream, and those that the guards see [s]."""
    true, told = defaultdict(list), defaultdict(list)
    with bench:
        acquire = GuardedAcquisition(
            bench, limits=limits(seconds), control=Control(), sink=MemorySink(),
            clock=SYSTEM_CLOCK,
        )  # fmt: skip
        acquire.arm()
        for k in range(ramps):
            acquire.start_ramp(0.0 if k % 2 else TOP_SPEED, None if k % 2 else 0.2)
            while acquire.ramping:
                batch = acquire.poll()
                now = SYSTEM_CLOCK.now()
                for name, samples in batch.raw.items():
                    true[name] += [true_age(sample, now, switched_on) for sample in samples]
                for name, taken in batch.taken.items():
                    stream = "drives" if name.endswith("drive") else name.replace(" ", "_")
                    told[stream] += (now - taken).tolist()
    return true, told


def measure(link: str, *, channel: str, ramps: int, seconds: float) -> None:
    """Measure one link and print its rows."""
    with twin_process(link, channel) as place:
        bench = make_bench(make_devices(place))
        true, told = ramp_ages(
            bench, float(str(place["switched_on"])), ramps=ramps, seconds=seconds
        )
    for stream, ages in true.items():
        name = "UDP, load cell" if stream == "load_cell" else NAMES[link]
        median, late, worst = 1e3 * np.percentile(ages, [50, 99, 100])
        seen = 1e3 * np.percentile(told[stream], 99)
        print(
            f"| {name} | {len(ages)} | {median:.1f} | {late:.1f} | {worst:.1f} | {seen:.1f} |",
            flush=True,
        )


def main() -> None:
    """Measure every link that this machine has."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--serve", choices=NAMES, help=argparse.SUPPRESS)
    parser.add_argument("--ramps", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--no-fit", action="store_true")
    parser.add_argument("--can", default="", help="such as socketcan:vcan0")
    wanted = parser.parse_args()
    if wanted.serve:
        serve(wanted.serve, wanted.can)
        return
    print("| link | readings | median [ms] | 99 % [ms] | worst [ms] | 99 % as guards see it [ms] |")
    print("|---|---:|---:|---:|---:|---:|")
    with fitting(not wanted.no_fit):
        for link in ("slcan", "serial", "can"):
            if link == "can" and not wanted.can:
                print("| CAN of the kernel, drives | none named by --can | | | | |")
                continue
            measure(link, channel=wanted.can, ramps=wanted.ramps, seconds=wanted.seconds)
    print(f"load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


if __name__ == "__main__":
    main()
