# SPDX-License-Identifier: MIT
"""What recording costs, beside a robot, an IMU and a load cell at full rate in another process.

python -m benchmarks.speed.recording [SECONDS [single] [shown]]

The load cell sends many records in a datagram, as `record` asks it to, or each in its own. With
`shown` the live display of `record` is drawn, too, for a terminal of 100 columns.
"""

import io
import multiprocessing
import resource
import socket
import sys
import tempfile
import time
from contextlib import closing
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.live import Live

from rig.acquisition import Device, acquiring
from rig.clock import SYSTEM_CLOCK
from rig.imu.profile import load_imu_profile
from rig.imu.simulated import SimulatedImu
from rig.imu.stream import ImuStream
from rig.links.serial import SerialLink
from rig.links.serve import PortServer
from rig.links.udp import UdpLink
from rig.slip_rig.load_cell import MOST_IN_ONE, RECORD, REQUEST, NetFtCell, Request
from rig.slip_rig.profile import load_rig_profile
from rig.twins import robot_twin
from rig.zebro.profile import load_leg_profile
from rig.zebro.serial import PacketLegs
from zebro_lab.recording.devices import PAUSE, ForceCheck, default_gait, profile_text
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.recording.screen import RecordScreen
from zebro_lab.recording.stage import LOOK_EVERY, Display
from zebro_lab.recording.status import StreamWatch
from zebro_lab.runs.manifest import RunManifest, read_manifest

LEGS = load_leg_profile("zebro-100-serial")
IMU = load_imu_profile("imu-quaternion-serial")
RIG = load_rig_profile("rig-odrive-netft")
assert RIG.load_cell is not None
CELL = RIG.load_cell


def serve(connection: Connection) -> None:
    """Serve all three until the other side hangs up."""
    rng = np.random.default_rng(0)
    cell = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    cell.bind(("127.0.0.1", 0))
    with (
        PortServer(robot_twin(LEGS, default_gait(), rng=rng)) as legs,
        PortServer(SimulatedImu(profile=IMU, rng=rng)) as imu,
    ):
        connection.send((legs.port, imu.port, cell.getsockname()))
        request, client = cell.recvfrom(64)
        each = MOST_IN_ONE if REQUEST.unpack(request)[1] == Request.START_BUFFERED else 1
        began, number, pending = time.monotonic(), 0, []
        while not connection.poll():
            forces = (1_500_000 + number % 997, 0, -6_000_000 - number % 1009, 0, 0, 0)
            while number < (time.monotonic() - began) * CELL.rate:
                number += 1
                pending.append(RECORD.pack(number, number, 0, *forces))
                if len(pending) == each:
                    cell.sendto(b"".join(pending), client)
                    pending.clear()
            time.sleep(0.001)


def cpu() -> float:
    """Return the processor time of this process [s]."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def measure(
    seconds: float, folder: Path, *, buffered: bool = True, shown: bool = False
) -> tuple[RunManifest, float, int]:
    """Record for a while; return the end record, the share of a core and the log's size [bytes]."""
    ours, theirs = multiprocessing.Pipe()
    server = multiprocessing.get_context("spawn").Process(target=serve, args=(theirs,), daemon=True)
    server.start()
    theirs.close()  # so that a server that fails is heard of
    if not ours.poll(60):
        raise TimeoutError("the simulated devices did not start within 60 s")
    legs_port, imu_port, address = ours.recv()
    streams = (
        PacketLegs(SerialLink(legs_port, baudrate=LEGS.baudrate), profile=LEGS),
        ImuStream(SerialLink(imu_port, baudrate=IMU.baudrate), profile=IMU),
        NetFtCell(UdpLink(*address), profile=CELL, buffered=buffered),
    )
    profiles = {name: (profile.name, profile_text(profile.name))
                for name, profile in (("legs", LEGS), ("imu", IMU), ("rig", RIG))}  # fmt: skip
    devices = [
        Device(stream, check, pause=PAUSE)
        for stream, check in zip(streams, (None, None, ForceCheck(RIG)), strict=True)
    ]
    manifest = RunManifest(kind="walk", label="bench", source="sim:bench")
    recorder = RunRecorder(folder, manifest=manifest, profiles=profiles)
    with streams[0], streams[1], streams[2], recorder:
        with acquiring(devices, sink=recorder, start=recorder.start) as readers:
            time.sleep(0.5)
            before, began = cpu(), time.monotonic()
            if shown:
                show(StreamWatch(recorder, readers, devices, None), seconds)
            else:
                time.sleep(seconds)
            share = (cpu() - before) / (time.monotonic() - began)
        for name, reader in readers.items():
            recorder.count(name, reader.counters)
    ours.send("enough")
    server.join(5)
    return read_manifest(recorder.folder), share, (recorder.folder / "log.mcap").stat().st_size


def show(streams: StreamWatch, seconds: float) -> None:
    """Draw the live display for a while, as `record` does."""
    console = Console(file=io.StringIO(), force_terminal=True, width=100, height=30)
    live = Live(console=console, auto_refresh=False, redirect_stdout=False, redirect_stderr=False)
    end = time.monotonic() + seconds
    with closing(Display(RecordScreen(console, live).show, give_up=print)) as display:
        while time.monotonic() < end:
            display.show(streams.status(SYSTEM_CLOCK.now()))
            time.sleep(LOOK_EVERY)


def report(manifest: RunManifest, share: float, size: int) -> None:
    """Print counters by stream, the share of a core, and bytes a sample."""
    print("| stream | received | lost | rejected | dropped |\n|---|---|---|---|---|")
    read = {name: each for name, each in manifest.counters.items() if each["received"]}
    for name, counters in read.items():
        rejected = sum(counters[key] for key in ("damaged", "repeated", "refused"))
        print(f"| {name} | {counters['received']} | {counters['lost']} | {rejected} | "
              f"{counters['dropped']} |")  # fmt: skip
    rows = sum(manifest.streams.values())
    print(f"\n{100 * share:.1f} % of one core, {size / rows:.0f} bytes a sample")


def main(arguments: list[str]) -> None:
    """Record for so many seconds, and print the tables."""
    with tempfile.TemporaryDirectory() as place:
        seconds = float(arguments[0]) if arguments else 10.0
        options = {"buffered": "single" not in arguments, "shown": "shown" in arguments}
        report(*measure(seconds, Path(place), **options))


if __name__ == "__main__":
    main(sys.argv[1:])
