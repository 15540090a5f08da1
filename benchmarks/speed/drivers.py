# SPDX-License-Identifier: MIT
"""How fast the drivers read, and how much damage they let through; prints the tables of drivers.md.

python -m benchmarks.speed.drivers [FRAMES]
"""

import resource
import socket
import sys
import time

import can
import numpy as np

from rig.clock import ManualClock
from rig.device import Counters, Sample
from rig.links.can import CanLink
from rig.links.faults import Faults, FaultyWire
from rig.links.packet import Kind, Packet, encode_packet
from rig.links.udp import UdpLink
from rig.slip_rig.load_cell import NetFtCell
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.rdt import RECORD
from rig.zebro.can import CLOCK, POSITIONS, CanLegs
from rig.zebro.profile import LegProfile, load_leg_profile
from rig.zebro.registers import DUMP_LENGTH, SYNC, DumpLegs
from rig.zebro.serial import PacketLegs

CHUNK = 3000
PROFILE = load_leg_profile("zebro-100-serial")


class Feed:
    """A byte link that hands on prepared chunks."""

    source = "sim:bench"
    reconnected = 0

    def __init__(self, data: bytes) -> None:
        self.clock = ManualClock()
        self.chunks = [data[i : i + CHUNK] for i in range(0, len(data), CHUNK)]

    def open(self) -> None:
        """Begin with the first chunk."""
        self.chunks.reverse()

    def close(self) -> None:
        """Do nothing."""

    def read(self, timeout: float) -> bytes:
        """Return the next chunk."""
        self.clock.sleep(1.2)  # a chunk at the profile's rate, so that losses are plausible
        return self.chunks.pop() if self.chunks else b""

    def write(self, data: bytes) -> bool:
        """Take bytes."""
        return True


def packets(count: int, rng: np.random.Generator) -> tuple[list[bytes], np.ndarray]:
    """Make the frames of a leg stream, and the counts in each."""
    counts = rng.integers(0, 100, (count, 6))
    body = PROFILE.words(6)
    frames = [
        encode_packet(Packet(Kind.LEGS, n, 10_000 * n, body.pack(*row)))
        for n, row in enumerate(counts.tolist())
    ]
    return frames, counts


def read_all(
    data: bytes, driver: type[PacketLegs | DumpLegs] = PacketLegs, profile: LegProfile = PROFILE
) -> tuple[list[Sample], float, Counters]:
    """Read prepared bytes by a driver; return samples, seconds and counters."""
    link = Feed(data)
    stream = driver(link, profile=profile, clock=link.clock)
    samples = []
    with stream:
        began = time.perf_counter()
        while link.chunks:
            samples += stream.read(0.0)
        return samples, time.perf_counter() - began, stream.counters


def serial_speed(count: int = 200_000) -> None:
    """Print how fast leg packets are read from a serial line."""
    frames, _ = packets(count, np.random.default_rng(0))
    data = b"".join(frames)
    samples, seconds, _ = read_all(data)
    line = 300_000 / (len(data) / count)  # 3 Mbaud, ten bits a byte
    report("serial packets", len(samples) / seconds, line)


def dump_speed(count: int = 20_000) -> None:
    """Print how fast dumps of registers are read."""
    data = (bytes(256) + SYNC) * count
    samples, seconds, _ = read_all(data, DumpLegs, load_leg_profile("vregs-dump"))
    report("register dumps", len(samples) / seconds, 200_000 / DUMP_LENGTH)


def can_speed(count: int = 40_000) -> None:
    """Print how fast frames are read from a virtual CAN bus."""
    with can.Bus(interface="virtual", channel="bench") as bus:
        stream = CanLegs(CanLink("virtual:bench"), profile=load_leg_profile("zebro-100-can"))
        with stream:
            for n in range(count // 2):
                for can_id, data in (
                    (0x120, CLOCK.pack(n % 65_536, 10_000 * n % (1 << 32))),
                    (0x121, POSITIONS.pack(1, 2, 3, 4, 5, 6, n % 65_536)),
                ):
                    bus.send(can.Message(arbitration_id=can_id, data=data, is_extended_id=False))
            began, found = time.perf_counter(), 0
            while found < count // 2:
                found += len(stream.read(0.1))
            seconds = time.perf_counter() - began
    report("CAN frames", count / seconds, 1e6 / 111)  # 8 data bytes, no stuff bits


def load_cell_cpu(seconds: float = 5.0, rate: int = 7000) -> None:
    """Measure the CPU that reading a load cell takes beside its sender, in one process."""
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.bind(("127.0.0.1", 0))
    sender.setblocking(False)
    profile = load_rig_profile("rig-odrive-netft").load_cell
    assert profile is not None
    cell = NetFtCell(UdpLink(*sender.getsockname()), profile=profile)
    spent, received, number = 0.0, 0, 0
    with cell:
        client = sender.recvfrom(64)[1]
        began = time.monotonic()
        while (elapsed := time.monotonic() - began) < seconds:
            while number < elapsed * rate:
                number += 1
                sender.sendto(RECORD.pack(number, number, 0, 1, 2, 3, 4, 5, 6), client)
            before = cpu()
            received += len(cell.read(0.004))
            spent += cpu() - before
    sender.close()
    lost = cell.counters.lost
    print(f"| load cell at {rate} Hz | {100 * spent / seconds:.1f} % of a core | {lost} lost |")


def cpu() -> float:
    """Return the processor time of this process [s]."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def damage(count: int) -> None:
    """Print what gets through when bits flip on the wire."""
    print("\n| bit error rate | frames sent | handed on | damaged among them | lost | rejected |")
    print("|---|---|---|---|---|---|")
    rng = np.random.default_rng(0)
    frames, counts = packets(count, rng)
    for flip in (1e-6, 1e-5, 1e-4, 1e-3, 1e-2):
        wire = FaultyWire(Faults(flip=flip), rng=rng)
        data = b"".join(wire.stream(frames[i : i + 1000]) for i in range(0, count, 1000))
        samples, _, counters = read_all(data)
        wrong = sum(tuple(counts[s.sequence]) != s.counts for s in samples)
        print(f"| {flip:.0e} | {count} | {len(samples)} | {wrong} | {counters.lost} | "
              f"{counters.rejected} |")  # fmt: skip


def report(name: str, rate: float, line: float) -> None:
    """Print a rate beside what the line carries [1/s]."""
    print(f"| {name} | {rate:,.0f} /s | {line:,.0f} /s | {rate / line:.1f} |")


def main(frames: int) -> None:
    """Print both tables, the second of so many frames."""
    print("| what | read | line carries | times |\n|---|---|---|---|")
    serial_speed()
    dump_speed()
    can_speed()
    load_cell_cpu()
    damage(frames)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000)
