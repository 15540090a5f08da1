# SPDX-License-Identifier: MIT
"""Walks on slopes and rough ground, by the command and by an independent engine.

The engine (group `bench`) walks the leg angles of the command's path.csv and searches each leg's
arc for the places where it touches the same ground. Compared are the path and, at every hundredth
of a second, which legs are in contact. What is allowed is less than what a wrong ground changes: on
a level plane in place of a slope of 5 degrees the path is off by half a percent only.

Usage: python -m benchmarks.accuracy.engine_ground [--seeds 10] [--only KIND] [--cycle 2] [--finer]
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import repeat
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.accuracy.engine_programs import COMMAND, FINE, angles_on_file, motion_on_file
from benchmarks.accuracy.rigid_engine.agreement import Agreement, Motion, agreement, motion_of
from benchmarks.accuracy.rigid_engine.arcs import FLAT, Heights
from benchmarks.accuracy.rigid_engine.references import refined
from benchmarks.accuracy.rigid_engine.stepping import Friction
from benchmarks.accuracy.rigid_engine.walking import SETTINGS, Settings, walk
from benchmarks.tables import print_table
from model.arrays import Array
from model.gait.reference import SampledReference
from model.robot import GRAVITY, Robot
from model.walk.dynamics import DEFAULT_OPTIONS, DynamicsOptions
from model.walk.dynamics import walk as dynamics_walk
from model.walk.traction import VelocityCoulomb
from zebro_lab.ground.ground_file import read_ground

FRICTION = 0.38
DURATION, CYCLE = 10.0, 2.0  # s
GAITS = {
    "straight": ["--gait", "tripod"],
    "left": ["--gait", "tripod", "--steering", "1.2"],
    "right": ["--gait", "tripod", "--steering", "1.3", "--direction", "right"],
}
ROUGHNESS, CORRELATION, GRID = 0.005, 0.05, 0.005  # m
ALLOWED = {"slope": 0.002, "rough": 0.01}  # of the length
HALF = 1.28  # m; half the side of the map, which repeats itself at twice that


@dataclass(frozen=True)
class Case:
    """A walk on a ground.

    Attributes:
        kind: slope or rough.
        name: What it is.
        gait: Key of `GAITS`.
        slope: Slope along x and y [deg].
        seed: Of a rough ground; none of an even one.
    """

    kind: str
    name: str
    gait: str
    slope: tuple[float, float] = (0.0, 0.0)
    seed: int | None = None


def slopes() -> list[Case]:
    """Return walks up, down and across a slope of 5 degrees."""
    return [
        Case("slope", "up 5°", "straight", (5.0, 0.0)),
        Case("slope", "down 5°", "straight", (-5.0, 0.0)),
        Case("slope", "across 5°", "straight", (0.0, 5.0)),
        Case("slope", "up 5°, turning left", "left", (5.0, 0.0)),
        Case("slope", "up 4° and across 3°, turning right", "right", (4.0, 3.0)),
    ]


def rough(seeds: int) -> list[Case]:
    """Return walks on rough ground."""
    gaits = list(GAITS)
    return [
        Case("rough", f"seed {seed}", str(np.random.default_rng(seed).choice(gaits)), seed=seed)
        for seed in range(1, seeds + 1)
    ]


def rough_heights(seed: int) -> Array:
    """Draw a Gaussian field of heights with a square-exponential correlation, periodic [m]."""
    n = round(2 * HALF / GRID)
    k = 2 * np.pi * np.fft.fftfreq(n, GRID)
    amplitude = np.exp(-0.25 * CORRELATION**2 * (k[:, None] ** 2 + k**2))
    noise = np.random.default_rng(seed).normal(size=(n, n))
    field = np.fft.ifft2(np.fft.fft2(noise) * amplitude).real
    return ROUGHNESS * (field - field.mean()) / field.std()


def engine_ground(case: Case) -> tuple[Heights, Friction]:
    """Return the ground and friction of a case for the engine."""
    z = np.zeros((1, 1)) if case.seed is None else rough_heights(case.seed)
    rise = np.tan(np.radians(case.slope))
    heights = FLAT._replace(
        z=z, highest=float(z.max()), rise_x=float(rise[0]), rise_y=float(rise[1])
    )
    if case.seed is not None:
        heights = heights._replace(x=-HALF, y=-HALF, step=GRID)
    return heights, Friction(FRICTION, 1e-3)


def write_ground(case: Case, folder: Path) -> Path:
    """Write ground.toml of a case, and heights.csv of a rough ground beside it."""
    folder.mkdir(parents=True)
    parts = [f"slope_deg = [{case.slope[0]}, {case.slope[1]}]"] if any(case.slope) else []
    if case.seed is not None:
        seen_from_above = rough_heights(case.seed).T[::-1]
        np.savetxt(folder / "heights.csv", seen_from_above, fmt="%.17g", delimiter=",")
        place = f"step = {GRID}, origin = [{-HALF}, {-HALF}]"
        parts.append(f'heights = {{ file = "heights.csv", {place} }}')
    file = folder / "ground.toml"
    file.write_text("\n\n".join(parts) + "\n")
    return file


def walk_by_command(case: Case, ground: Path, cycle: float) -> pd.DataFrame:
    """Walk a case by the command in cycles of a time [s]; return the table of its path.csv."""
    out = ground.with_name("walk")
    command = [COMMAND, "walk", *GAITS[case.gait], "--duration", f"{DURATION:g}", "--out", out]
    command += ["--cycle", f"{cycle:g}", "--slip", f"coulomb:{FRICTION:g}:0.001"]
    command += ["--ground", ground]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"walk on {ground} ended with {done.returncode}:\n{done.stderr}")
    return pd.read_csv(out / "path.csv")


def walk_by_model(
    ground: Path, t: Array, theta: Array, options: DynamicsOptions = DEFAULT_OPTIONS
) -> Motion:
    """Walk leg angles on the ground of a file by our model, without the command."""
    robot = Robot()
    table = VelocityCoulomb(FRICTION, 1e-3).table(weight=robot.mass * GRAVITY)
    path = dynamics_walk(
        robot, SampledReference(t, theta), table, duration=float(t[-1]), options=options,
        ground=read_ground(ground).ground,
    )  # fmt: skip
    return Motion(path.t, path.position[:, :2], path.yaw, path.normal_force)


@dataclass(frozen=True)
class Compared:
    """A walk by the command and by the engine.

    Attributes:
        case: The case.
        errors: Of the command's walk against the engine's.
        refined: Errors of our model in steps of 0.25 ms; then changes of the engine's walk with
            half the step, and with contacts four times as stiff; none unless asked for.
    """

    case: Case
    errors: Agreement
    refined: tuple[Agreement, ...]


def compare(case: Case, folder: Path, finer: bool = False, cycle: float = CYCLE) -> Compared:
    """Walk a case by the command and by the engine, and compare."""
    ground = write_ground(case, folder / f"{case.kind} {case.name}")
    table = walk_by_command(case, ground, cycle)
    t, theta = table["t"].to_numpy(), angles_on_file(table)
    heights, friction = engine_ground(case)

    def engine(settings: Settings) -> Motion:
        """Walk the case's leg angles by the engine with some steps and contacts."""
        return motion_of(walk(Robot(), t, theta, friction, heights=heights, settings=settings))

    truth, changes = engine(SETTINGS), ()
    if finer:
        walks = (walk_by_model(ground, t, theta, FINE), *(engine(each) for each in refined()))
        changes = tuple(agreement(each, truth) for each in walks)
    return Compared(case, agreement(motion_on_file(table), truth), changes)


def print_compared(all_compared: Sequence[Compared]) -> None:
    """Print each walk's row, then median and worst of each kind."""
    head = ("ground", "walk", "gait", "path", "contacts agree")
    finer = bool(all_compared[0].refined)
    if finer:
        head += ("in steps of 0.25 ms", "engine, half the step", "contacts four times as stiff")
    print_table(head, *(_row(each) for each in all_compared))
    for kind in dict.fromkeys(each.case.kind for each in all_compared):
        errors = [each.errors for each in all_compared if each.case.kind == kind]
        path = 100 * np.array([each.path for each in errors])
        contacts = 100 * np.array([each.contacts for each in errors])
        print(
            f"{kind}: path median {np.median(path):.2f} %, worst {path.max():.2f} %; contacts "
            f"agree median {np.median(contacts):.1f} %, worst {contacts.min():.1f} %; "
            f"{(path <= 100 * ALLOWED[kind]).sum()} of {len(path)} paths within "
            f"{100 * ALLOWED[kind]:g} %"
        )


def _row(one: Compared) -> tuple[str, ...]:
    """Return the cells of a walk."""
    return (
        one.case.kind, one.case.name, one.case.gait, f"{100 * one.errors.path:.2f} %",
        f"{100 * one.errors.contacts:.1f} %", *(f"{100 * each.path:.2f} %" for each in one.refined),
    )  # fmt: skip


def main(arguments: list[str] | None = None) -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10, help="of rough ground")
    parser.add_argument("--only", choices=("slope", "rough"))
    parser.add_argument("--cycle", type=float, default=CYCLE, help="of the gait [s]")
    parser.add_argument("--finer", action="store_true", help="refine our model and the engine, too")
    parser.add_argument("--processes", type=int, default=2, help="at a time")
    parser.add_argument("--keep", type=Path, help="new folder for grounds and walks")
    asked = parser.parse_args(arguments)
    cases = slopes() + rough(asked.seeds)
    cases = [case for case in cases if asked.only in (None, case.kind)]
    all_compared = []
    with (
        tempfile.TemporaryDirectory() as scratch,
        ProcessPoolExecutor(asked.processes, get_context("spawn")) as pool,
    ):
        folder = asked.keep or Path(scratch)
        finer, cycle = repeat(asked.finer), repeat(asked.cycle)
        for one in pool.map(compare, cases, repeat(folder), finer, cycle):
            print(*_row(one), sep="  ", file=sys.stderr, flush=True)
            all_compared.append(one)
    print_compared(all_compared)


if __name__ == "__main__":
    main()
