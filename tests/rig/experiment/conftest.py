# SPDX-License-Identifier: MIT
"""Twins of a board, and of drives, on a clock turned by hand, and a short plan for them."""

import copy
import tomllib
from collections import deque
from dataclasses import dataclass

import numpy as np
import pytest

from rig.backends import RigDevices
from rig.clock import ManualClock
from rig.experiment.acquire import GuardedAcquisition
from rig.experiment.bench import make_bench
from rig.experiment.control import Control
from rig.experiment.load import SimulatedOperator
from rig.experiment.plan import Plan
from rig.experiment.plan_reading import parse_plan
from rig.experiment.run import run_plan
from rig.links.byte_link import MemoryLink
from rig.profile import ProfileTable
from rig.slip_rig.board import RigBoard
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan
from support.memory_sink import MemorySink
from support.stepped_drives import stepped_drives

PROFILE = load_rig_profile("rig-board-serial")
DRIVES_PROFILE = load_rig_profile("rig-odrive-netft")

PLAN = """
schema = 1
name = "short"
material = "simulated"

[points]
loads = [4.0, 8.0]
slips = [0.02, 0.2, 0.8]
omega_leg = 12.0
length = "duration"
duration = 0.3
order = "monotone"

[load]
set_by = "hand"
tolerance = 0.3

[settle]
window = 0.2
speed = 0.3
friction = 0.3
timeout = 3.0

[accept]
slip = 0.02
slip_drift = 0.03
friction_drift = 0.3

[controls]
tare_duration = 0.3

[limits]
speed = 40.0
acceleration = 40.0
normal_force = 25.0
traction_force = 15.0
speed_error = 4.0
hold = 5.0
"""


def plan(*, drop=None, **changes) -> Plan:
    """Parse the short plan; changes are `table={key: value}`, `drop` a table and a key."""
    entries = copy.deepcopy(tomllib.loads(PLAN))
    if drop is not None:
        del entries[drop[0]][drop[1]]
    for table, values in changes.items():
        entries[table] |= values
    return parse_plan(ProfileTable(entries, file="plan.toml"))


@dataclass
class Twin:
    """A rig, its bench, and what a run on it needs; `board` may be the drives."""

    rig: SimulatedRig
    board: object
    bench: object
    clock: ManualClock
    control: Control
    sink: MemorySink

    def run(self, wanted=None, **options):
        settings = {
            "bench": self.bench, "load": SimulatedOperator(self.rig), "sink": self.sink,
            "control": self.control, "clock": self.clock, "period": 0.01,
        }  # fmt: skip
        return run_plan(wanted or plan(), **(settings | options))

    def acquisition(self, wanted) -> GuardedAcquisition:
        return GuardedAcquisition(
            self.bench, limits=wanted.limits, control=self.control, sink=self.sink,
            clock=self.clock, period=0.01,
        )  # fmt: skip

    @staticmethod
    def turn(acquire):
        """Energise the discs and wait until they turn at a slip ratio of 0.2."""
        acquire.arm()
        acquire.start_ramp(12.0, 0.2)
        acquire.until(lambda _: not acquire.ramping, 2.0)

    def at_rest(self) -> bool:
        """Let half a second pass and tell whether both discs stand."""
        self.rig.advance(self.clock.now() + 0.5)
        return all(abs(omega) < 0.1 for _, omega in self.rig.speeds().values())


class At(MemorySink):
    """A sink that does something when so many batches were written."""

    def __init__(self, count, action):
        super().__init__()
        self.count, self.action, self.written = count, action, 0

    def write(self, readings, batch):
        super().write(readings, batch)
        self.written += 1
        if self.written == self.count:
            self.action()


def twin(seed=0, *, kind="board", watchdog=0.2) -> Twin:
    rng = np.random.default_rng(seed)
    rig = SimulatedRig(plan=SweepPlan(), imperfections=TYPICAL_RIG, dynamics=RigDynamics(), rng=rng)
    clock = ManualClock()
    if kind == "drives":
        rig.command("leg", 0.0)
        drives, devices = stepped_drives(rig, DRIVES_PROFILE, clock, watchdog=watchdog)
        return Twin(rig, drives, make_bench(devices), clock, Control(), MemorySink())
    board = SimulatedBoard(rig, profile=PROFILE.board, rng=rng, watchdog=watchdog)
    driver = RigBoard(
        MemoryLink(board, clock=clock), profile=PROFILE.board, limits=PROFILE.limits, clock=clock
    )
    bench = make_bench(RigDevices(PROFILE, board=driver))
    return Twin(rig, board, bench, clock, Control(), MemorySink())


@pytest.fixture(name="lab")
def _lab():
    """Return what makes twins and plans."""
    return {"twin": twin, "plan": plan, "At": At}


class LaggingLink(MemoryLink):
    """Hands on what the twin sends ever later, as a link does whose buffers fill.

    Args:
        growth: How much later a byte comes for each second that passes [-].
    """

    growth = 0.0

    def read(self, timeout):
        self.waiting = getattr(self, "waiting", deque())
        self.behind = getattr(self, "behind", 0.0)
        now = self._clock.now()
        self.behind += self.growth * (now - getattr(self, "read_at", now))
        self.read_at = now
        if data := super().read(timeout):
            self.waiting.append((now + self.behind, data))
        out = b""
        while self.waiting and self.waiting[0][0] <= now:
            out += self.waiting.popleft()[1]
        return out


@pytest.fixture(name="lagging")
def _lagging():
    """Return what puts a lagging link to a board's twin; it gives link and acquisition."""

    def put(twin, wanted):
        twin.clock = ManualClock()
        link = LaggingLink(twin.board, clock=twin.clock)
        board = RigBoard(link, profile=PROFILE.board, limits=PROFILE.limits, clock=twin.clock)
        twin.bench = make_bench(RigDevices(PROFILE, board=board))
        return link, twin.acquisition(wanted)

    return put
