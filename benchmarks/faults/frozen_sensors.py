# SPDX-License-Identifier: MIT
"""False stops of a whole plan, and frozen sensors seen, by the resolution of the sensors.

python -m benchmarks.faults.frozen_sensors [--seeds N] [--points N] [--trials N] [--rows N]

Prints a table of experiments.md. Each seed is a simulated rig of its own, read by a board whose
force and speed counts are as coarse as the row says. The plan is the thesis's, its time passes at
once. Then forces, and in a new start the leg disc's speed, freeze after 3 s of steady turning.
"""

import argparse
import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rig.backends import RigDevices
from rig.clock import ManualClock
from rig.errors import FrozenReading, RigError
from rig.experiment.acquire import GuardedAcquisition
from rig.experiment.bench import Bench, make_bench
from rig.experiment.control import Control
from rig.experiment.load import SimulatedOperator
from rig.experiment.plan import Plan
from rig.experiment.run import run_plan
from rig.links.memory import MemoryLink
from rig.slip_rig.board import RigBoard
from rig.slip_rig.imperfections import draw_imperfections
from rig.slip_rig.profile import load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan
from support.memory_sink import MemorySink
from zebro_lab.experiment.plan_file import read_plan

PERIOD = 0.02
THESIS_PLAN = Path(__file__).parents[2] / "examples" / "plan-thesis.toml"
RESOLUTIONS = ((1e-5, 1e-4), (0.001, 0.001), (0.01, 0.01), (0.02, 0.02), (0.1, 0.05), (0.1, 0.1),
               (0.5, 0.2))  # fmt: skip
"""Newtons and rad/s of one count; the first are those of the shipped profile."""


class FreezableBoard(SimulatedBoard):
    """A board of which some counts can be frozen."""

    frozen: tuple[int, ...] = ()
    _kept: tuple[int, ...] | None = None

    def _encode(self, number: int, counts: tuple[int, ...]) -> bytes:
        self._kept = counts if self._kept is None or not self.frozen else self._kept
        mixed = [self._kept[k] if k in self.frozen else count for k, count in enumerate(counts)]
        return super()._encode(number, tuple(mixed))


class Forgetful(MemorySink):
    """A sink that keeps no samples."""

    def write(self, readings: object, batch: object) -> None:
        """Drop them."""


@dataclass(frozen=True)
class Lab:
    """A rig with coarse sensors."""

    rig: SimulatedRig
    board: FreezableBoard
    bench: Bench
    clock: ManualClock


def make_lab(seed: int, newtons: float, speed: float) -> Lab:
    """Make a rig of its own whose counts are so coarse [N, rad/s]."""
    profile = load_rig_profile("rig-board-serial")
    assert profile.board is not None
    settings = replace(profile.board, counts_per_force=1 / newtons, counts_per_speed=1 / speed)
    profile = replace(profile, board=settings)
    rng, clock = np.random.default_rng(seed), ManualClock()
    rig = SimulatedRig(
        plan=SweepPlan(), imperfections=draw_imperfections(np.random.default_rng([seed, 1])),
        dynamics=RigDynamics(ripple=0.005), rng=rng,
    )  # fmt: skip
    rig.command("leg", 0.0)
    twin = FreezableBoard(rig, profile=settings, rng=rng)
    board = RigBoard(
        MemoryLink(twin, clock=clock), profile=settings, limits=profile.limits, clock=clock
    )
    return Lab(rig, twin, make_bench(RigDevices(profile, board=board)), clock)


def go_through(lab: Lab, plan: Plan) -> str:
    """Go through a plan; say what stopped it, nothing where nothing did."""
    try:
        run_plan(
            plan, bench=lab.bench, load=SimulatedOperator(lab.rig), sink=Forgetful(),
            control=Control(), clock=lab.clock, period=PERIOD,
        )  # fmt: skip
    except RigError as error:
        return str(error)
    return ""


def freeze(lab: Lab, plan: Plan, channels: tuple[int, ...]) -> float | None:
    """Freeze channels after 3 s of turning; return when that is seen, None if never [s]."""
    lab.rig.load = 8.0
    with lab.bench:
        acquire = GuardedAcquisition(
            lab.bench, limits=plan.limits, control=Control(), sink=Forgetful(), clock=lab.clock,
            period=PERIOD,
        )  # fmt: skip
        acquire.arm()
        acquire.start_ramp(plan.points.omega_leg, 0.2)
        acquire.until(lambda _: False, 3.3)
        lab.board.frozen, began = channels, lab.clock.now()
        try:
            acquire.until(lambda _: False, 3.0)
        except FrozenReading:
            return lab.clock.now() - began
    return None


def seen(
    plan: Plan, resolution: tuple[float, float], channels: tuple[int, ...], *, trials: int
) -> str:
    """Say how many of the frozen sensors were seen, and within what time at most."""
    found = [freeze(make_lab(seed, *resolution), plan, channels) for seed in range(trials)]
    times = [time for time in found if time is not None]
    return f"{len(times)} of {trials}" + (f", {max(times):.2f} s" if times else "")


def main(report: Callable[[str], None] = print) -> None:
    """Print a row for each resolution."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--points", type=int, default=62, help="slip ratios at each load")
    parser.add_argument("--trials", type=int, default=20, help="frozen sensors of a row")
    parser.add_argument("--rows", type=int, default=len(RESOLUTIONS))
    wanted = parser.parse_args()
    plan = read_plan(THESIS_PLAN)
    slips = tuple(np.linspace(0.0, 1.0, wanted.points).tolist())
    plan = replace(plan, points=replace(plan.points, slips=slips))
    report("| a count is | plans | false stops | frozen forces seen | frozen speed seen |")
    report("|---|---:|---:|---:|---:|")
    for resolution, seeds in zip(
        RESOLUTIONS[: wanted.rows],
        itertools.chain([wanted.seeds], itertools.repeat(1)),
        strict=False,
    ):
        stops = [go_through(make_lab(seed, *resolution), plan) for seed in range(seeds)]
        forces, speed = (
            seen(plan, resolution, channels, trials=wanted.trials) for channels in ((0, 1), (2,))
        )
        newtons, rate = resolution
        report(
            f"| {newtons:g} N, {rate:g} rad/s | {seeds} | {sum(map(bool, stops))} | {forces} | "
            f"{speed} |"
        )
        for stop in filter(None, stops):
            report(f"stopped: {stop}")


if __name__ == "__main__":
    main()
