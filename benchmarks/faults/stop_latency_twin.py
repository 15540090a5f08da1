# SPDX-License-Identifier: MIT
"""A rig that breaks on order and dates what comes on its wire, for `stop_latency.py`.

Its process has the monotonic clock. Commands are dated up to a poll (2 ms) after their last byte.
"""

import contextlib
import multiprocessing
import os
import time
from collections import deque
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from typing import Any, Final

import can
import numpy as np

from rig.links.packet import Kind, Packet
from rig.links.serve import PortServer, Ticker
from rig.links.slcan import SlcanAdapter
from rig.slip_rig.can_simple import AxisState, Command
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.load_cell import SATURATED
from rig.slip_rig.profile import BoardProfile, load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.simulated_drives import SimulatedDrives
from rig.slip_rig.simulated_load_cell import SimulatedLoadCell
from rig.slip_rig.sweep import SweepPlan

TOP_SPEED: Final = 12.0
"""Set-point of the leg disc when the fault comes [rad/s]."""
SPEED_ERROR: Final = 4.0
READING_AGE: Final = 0.25
"""Limits of the plan, for the first reading beyond each [rad/s, s]."""
RESTART_EVERY: Final = 100
"""Samples after which a broken board numbers anew."""
SLOWER: Final = 4
"""A lagging link hands on one reading in so many that come."""
REST: Final = 0.1
ANSWER_TIMEOUT: Final = 20.0
"""Longest wait for the twin [s]."""


@dataclass(frozen=True)
class Seen:
    """What the twin saw.

    Attributes:
        fault_at: When the first sample beyond a limit was due; None before it.
        commands: Time, set-point of the leg disc, and whether both drives are told to stop.
        speeds: Time and the larger true speed of both discs.
        expired_at: When the watchdog last stopped the discs; None where it did not.
    """

    fault_at: float | None
    commands: tuple[tuple[float, float, bool], ...]
    speeds: tuple[tuple[float, float], ...]
    expired_at: float | None


@dataclass
class Log:
    """What happens in the twin, and which fault it has."""

    wanted: str = ""
    fault: str = ""
    fault_at: float | None = None
    polled_at: float = 0.0
    expired_at: float | None = None
    commands: list[tuple[float, float, bool]] = field(default_factory=list)
    speeds: list[tuple[float, float]] = field(default_factory=list)

    def begin_poll(self, rig: SimulatedRig) -> None:
        """Let a fault begin; every sample that is due after the poll before has it."""
        if self.wanted and not self.fault:
            self.fault = self.wanted
            if self.fault not in ("departure", "old readings"):
                self.fault_at = self.polled_at
        self.polled_at = time.monotonic()
        self.speeds.append((self.polled_at, max(map(abs, rig._omega.values()))))

    def beyond(self, at: float) -> None:
        """Take when the first reading beyond a limit was sent."""
        if self.fault_at is None:
            self.fault_at = at

    def seen(self) -> Seen:
        """Return it all."""
        return Seen(self.fault_at, tuple(self.commands), tuple(self.speeds), self.expired_at)


class PlantedBoard(SimulatedBoard):
    """A board that breaks on order."""

    def __init__(self, rig: SimulatedRig, log: Log, profile: BoardProfile) -> None:
        super().__init__(rig, profile=profile, rng=np.random.default_rng(1))
        self._log = log
        self._random = np.random.default_rng(2)
        self._last: tuple[int, ...] | None = None
        self._began: int | None = None
        self._late: deque[tuple[float, bytes]] = deque()
        self._let = 0.0

    def poll(self, now: float, received: bytes) -> bytes:
        """Look for orders, then do as a board does."""
        self._log.begin_poll(self._rig)
        before = self._status
        data = super().poll(now, received)
        if self._status and not before:
            self._log.expired_at = time.monotonic()
        return b"" if self._log.fault == "silence" else data

    def _frames(self, due: int) -> list[bytes]:
        numbers = range(self._number + 1, due + 1)
        frames = super()._frames(due)
        if self._log.fault == "damaged records":
            return [f if k % 4 == 0 else f[:9] + bytes([f[9] ^ 0x55]) + f[10:]
                    for k, f in enumerate(frames, self._number)]  # fmt: skip
        if self._log.fault != "old readings":
            return frames
        switched_on = self._rig._switched_on or 0.0
        taken = [switched_on + number / self._profile.rate for number in numbers]
        self._late.extend(zip(taken, frames, strict=True))
        self._let += len(frames) / SLOWER
        out = []
        while self._late and self._let >= 1:
            self._let -= 1
            at, frame = self._late.popleft()
            out.append(frame)
            if time.monotonic() - at > READING_AGE:
                self._log.beyond(time.monotonic())
        return out

    def _encode(self, number: int, counts: tuple[int, ...]) -> bytes:
        return super()._encode(*self._broken(number, counts))

    def _broken(self, number: int, counts: tuple[int, ...]) -> tuple[int, tuple[int, ...]]:
        fault, force = self._log.fault, self._profile.counts_per_force
        normal, traction, leg, ground, status = counts
        if fault == "normal force":
            normal = round(40 * force)
        elif fault == "traction force":
            traction = round(18 * force)
        elif fault == "status":
            status = 2
        elif fault.startswith("frozen"):
            old = self._last = self._last or counts
            normal, traction = old[:2] if fault == "frozen forces" else (normal, traction)
            leg = old[2] if fault == "frozen leg speed" else leg
            ground = old[3] if fault == "frozen ground speed" else ground
        elif fault == "restarts":
            self._began = number if self._began is None else self._began
            number = (number - self._began) % RESTART_EVERY + 1
        elif fault == "random numbers":
            number = int(self._random.integers(1 << 32))
        elif fault == "departure":
            self._look_at_departure(number, leg / self._profile.counts_per_speed)
        return number, (normal, traction, leg, ground, status)

    def _look_at_departure(self, number: int, leg: float) -> None:
        if abs(leg - TOP_SPEED) > SPEED_ERROR:
            self._log.beyond((self._rig._switched_on or 0.0) + number / self._profile.rate)

    def _execute(self, packet: Packet, now: float) -> None:
        at = time.monotonic()
        if packet.kind == Kind.STOP:
            self._log.commands.append((at, 0.0, True))
        elif packet.kind == Kind.DISC_SPEEDS:
            leg, ground = self._command.unpack(packet.body)
            speed = leg / self._profile.counts_per_speed
            self._log.commands.append((at, speed, leg == 0 == ground))
        super()._execute(packet, now)
        if self._log.fault == "departure" and not self._status:
            self._rig.command("leg", 1.5 * self._log.commands[-1][1])  # it runs away by a half


class PlantedDrives(SimulatedDrives):
    """Drives that break on order."""

    def __init__(self, log: Log, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._log = log
        self._broken = False

    def poll(self, now: float) -> None:
        """Look for orders, then do as drives do."""
        self._log.begin_poll(self._rig)
        if self._log.fault == "temperature":
            self.temperature = 95.0
        elif self._log.fault == "drive error" and not self._broken:
            self._broken = True
            self.trip("leg", 0x40)
            self._heartbeat_at = -np.inf  # told at once
        before = self._told_to_stop()
        super().poll(now)
        if self._told_to_stop() and not before and not self._log.commands[-1][2]:
            self._log.expired_at = time.monotonic()

    def _told_to_stop(self) -> bool:
        return all(axis.state == AxisState.IDLE for axis in self._axes.values())

    def _send(self, axis: Any, command: Command, data: bytes) -> None:
        if self._log.fault != "silent drive" or axis.disc != "leg":
            super()._send(axis, command, data)

    def _answer(self, axis: Any, command: int, now: float) -> None:
        if self._log.fault != "silent temperature":
            super()._answer(axis, command, now)

    def _execute(self, axis: Any, command: int, data: bytes, now: float) -> None:
        at = time.monotonic()
        super()._execute(axis, command, data, now)
        leg = next(a for a in self._axes.values() if a.disc == "leg")
        speed = abs(leg.velocity) * 2 * np.pi / leg.place.gear
        self._log.commands.append((at, speed, self._told_to_stop()))


class PlantedCell(SimulatedLoadCell):
    """A load cell that breaks on order."""

    def __init__(self, log: Log, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._log = log

    def poll(self, now: float) -> None:
        """Do as a load cell does, with what the order wants."""
        fault = self._log.fault
        self.status = SATURATED | 1 << 31 if fault == "saturation" else 0
        self.lateral_force = 18.0 if fault == "lateral force" else 0.0
        self.torque = 2.0 if fault == "torque" else 0.0
        super().poll(now)

    def _emit(self, datagram: bytes) -> None:
        if self._log.fault != "silent load cell":
            super()._emit(datagram)


class Twin:
    """The twin's process, seen from outside.

    Attributes:
        place: Port of its devices; a load cell's port beside it.
    """

    def __init__(self, process: Any, pipe: Any) -> None:
        self._process = process
        self._pipe = pipe
        self.place: dict[str, Any] = self._ask("place")

    def load(self, force: float) -> None:
        """Press the discs together [N]."""
        self._ask("load", force)

    def fail(self, fault: str) -> None:
        """Let it break."""
        self._ask("fault", fault)

    def seen(self) -> Seen:
        """Return what it has seen."""
        return self._ask("seen")

    def _ask(self, what: str, value: Any = None) -> Any:
        self._pipe.send((what, value))
        if not self._pipe.poll(ANSWER_TIMEOUT):
            raise TimeoutError(f"the twin did not answer within {ANSWER_TIMEOUT:g} s")
        return self._pipe.recv()


@contextmanager
def twin_process(rig: str) -> Iterator[Twin]:
    """Start a twin in a process of its own.

    Args:
        rig: `board`, or `drives` behind an SLCAN adapter with a load cell.
    """
    context = multiprocessing.get_context("fork")
    near, far = context.Pipe()
    process = context.Process(target=_serve, args=(rig, far), daemon=True)
    process.start()
    try:
        yield Twin(process, near)
    finally:
        process.kill()
        process.join()


def _serve(kind: str, pipe: Any) -> None:
    # It stands for hardware that waits for no processor: first in turn, where that is allowed.
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    rig = SimulatedRig(
        plan=SweepPlan(), imperfections=replace(TYPICAL_RIG, bump_height=0.0),
        dynamics=RigDynamics(ripple=0.005), rng=np.random.default_rng(0),
    )  # fmt: skip
    rig.load = 1e-3
    rig.command("leg", 0.0)
    log = Log()
    with ExitStack() as stack:
        place = (_board if kind == "board" else _drives)(stack, rig, log)
        while True:
            try:
                what, value = pipe.recv()
            except EOFError:
                return
            if what == "load":
                rig.load = value
            elif what == "fault":
                log.wanted = value
            pipe.send({"place": place}.get(what, log.seen() if what == "seen" else None))


def _board(stack: ExitStack, rig: SimulatedRig, log: Log) -> dict[str, Any]:
    profile = load_rig_profile("rig-board-serial").board
    assert profile is not None
    return {"port": stack.enter_context(PortServer(PlantedBoard(rig, log, profile))).port}


def _drives(stack: ExitStack, rig: SimulatedRig, log: Log) -> dict[str, Any]:
    profile = load_rig_profile("rig-odrive-netft")
    assert profile.drives is not None
    assert profile.load_cell is not None
    near, far = (
        stack.enter_context(can.Bus(interface="virtual", channel="latency")) for _ in range(2)
    )
    adapter = PortServer(SlcanAdapter(far, source="sim:rig"))
    adapter.plug_in()
    stack.callback(adapter.unplug)
    drives = PlantedDrives(log, rig, near, profile=profile.drives)
    cell = stack.enter_context(
        PlantedCell(log, rig, profile=profile.load_cell, rng=np.random.default_rng(1))
    )

    def tick(now: float) -> None:  # one thread for all: two would wait for one another
        drives.poll(now)
        adapter._tick(now)
        cell.poll(now)

    stack.enter_context(Ticker(tick))
    return {"port": f"slcan:{adapter.port}", "cell": cell.port}


def rest_after(seen: Seen, since: float) -> float | None:
    """Return when both discs truly stood for good, after a time; None where they never did [s]."""
    turning = [at for at, speed in seen.speeds if speed >= REST]
    if not seen.speeds or not turning or turning[-1] == seen.speeds[-1][0]:
        return None
    return max(since, turning[-1])
