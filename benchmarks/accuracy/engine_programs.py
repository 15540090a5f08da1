# SPDX-License-Identifier: MIT
"""Random walking programs, walked by the command and by an engine that shares no code with it.

Each program is written to a file and walked by `zebro-lab walk PROGRAM`; the engine (group `bench`)
walks the leg angles of its path.csv. Programs change gaits, curve, turn on the spot, stand and walk
backwards. Compared are path and heading, of the command and of our model in steps so short that
they make no difference any more.

To show that errors would be seen, the steering term, 1 less the steering, of all curves and turns
on the spot is made 5 % too small, in the same cycles, and compared with the engine's walks of the
right programs.

Usage: python -m benchmarks.accuracy.engine_programs [--programs 20] [--seed 1] [--finer]
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

from benchmarks.accuracy.random_programs import Program, random_program
from benchmarks.accuracy.rigid_engine.agreement import (
    Agreement,
    Motion,
    agreement,
    motion_of,
    whole_turn,
)
from benchmarks.accuracy.rigid_engine.references import refined
from benchmarks.accuracy.rigid_engine.stepping import Friction
from benchmarks.accuracy.rigid_engine.walking import SETTINGS, Settings, walk
from benchmarks.tables import print_table
from model.arrays import Array
from model.gait.program import CycleGait, ProgramLegs
from model.gait.reference import LegReference, SampledReference
from model.robot import GRAVITY, N_LEGS, Robot
from model.routes.program import lay_out
from model.walk.dynamics import DynamicsOptions
from model.walk.dynamics import walk as dynamics_walk
from model.walk.traction import TractionTable, VelocityCoulomb
from zebro_lab.walk.program_file import read_program

ALLOWED_PATH, ALLOWED_HEADING = 0.015, 0.02  # of the length, of the whole turn
LIMITS = "1.5 % of path and 2 % of heading"
STEERING_ERROR = 0.95  # of the steering term of curves and turns, planted
FINE = DynamicsOptions(dt=0.00025)
LEGS = range(1, N_LEGS + 1)
ROBOT = Robot()
_WORDS = {
    "errors": "by command",
    "converged": "in steps of 0.25 ms",
    "planted": "with the steering term 5 % off",
}
COMMAND = Path(sys.executable).with_name("zebro-lab")


@dataclass(frozen=True)
class Compared:
    """A program walked by the command and by the engine.

    Attributes:
        program: The program.
        duration: Time walked [s].
        turned: Changes of heading, left and right added [rad].
        errors: Of the command's path against the engine's.
        converged: The same of our model in steps of 0.25 ms.
        planted: The same of the command's steps, with the steering off.
        angle_error: Largest departure of the engine's legs from their angles [rad].
        refined: Changes of the engine's walk with half the step, and with contacts four times as
            stiff; none unless asked for.
    """

    program: Program
    duration: float
    turned: float
    errors: Agreement
    converged: Agreement
    planted: Agreement
    angle_error: float
    refined: tuple[Agreement, ...] = ()


def write_program(program: Program, folder: Path, share: float = 1.0) -> Path:
    """Write a program's file, with a share of its steering term."""
    file = folder / f"program_{program.number}_{share:g}.toml"
    file.write_text(program.toml(share))
    return file


def walk_by_command(program: Program, folder: Path) -> pd.DataFrame:
    """Walk a program by the command and return the table of its path.csv."""
    file = write_program(program, folder)
    out = folder / file.stem
    command = [COMMAND, "walk", file, "--out", out]
    command += ["--slip", f"coulomb:{program.friction:g}:0.001"]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"walk {file.name} ended with {done.returncode}:\n{done.stderr}")
    return pd.read_csv(out / "path.csv")


def steered_wrongly(program: Program, folder: Path) -> ProgramLegs:
    """Return the legs of a program with the planted error, in cycles of the right one's times.

    Headings that end segments are found by walking the right program, as the error would not be
    felt in turns that go on until a heading is reached.
    """
    right, wrong = (
        read_program(write_program(program, folder, share), leg_arc=ROBOT.leg_arc).segments
        for share in (1.0, STEERING_ERROR)
    )
    options = DynamicsOptions()
    legs, _ = lay_out(right, ROBOT, coulomb_table(program.friction), options=options)
    pairs = [(a.gait, b.gait) for a, b in zip(right, wrong, strict=True) if a.gait and b.gait]
    return replayed(legs, pairs)


def replayed(legs: ProgramLegs, gaits: Sequence[tuple[CycleGait, CycleGait]]) -> ProgramLegs:
    """Return the cycles of a program again, of other gaits: pairs of the old and the new one."""

    def other(gait: CycleGait) -> CycleGait:
        """Return the gait that takes the place of one."""
        return next(new for old, new in gaits if old is gait)

    again = ProgramLegs.beginning_with(other(legs.cycles[0].gait))
    for cycle in legs.cycles[1:]:
        if cycle.handed is not None and cycle.handed[2] > 0:
            again = again.with_stand(cycle.handed[2])
        again = again.with_cycle(other(cycle.gait))
        if cycle.stopped is not None:
            again = again.stopped_at(cycle.stopped[0])
    return again.with_stand(legs.standing) if legs.standing > 0 else again


def coulomb_table(friction: float) -> TractionTable:
    """Tabulate friction of 71 % at 1 mm/s, as the command does."""
    return VelocityCoulomb(friction, 1e-3).table(weight=ROBOT.mass * GRAVITY)


def motion_by_model(
    friction: float, legs: LegReference, duration: float, options: DynamicsOptions
) -> Motion:
    """Walk leg angles by our model and return what is compared."""
    table = coulomb_table(friction)
    path = dynamics_walk(ROBOT, legs, table, duration=duration, options=options)
    return Motion(path.t, path.position[:, :2], path.yaw, path.normal_force)


def motion_on_file(table: pd.DataFrame) -> Motion:
    """Return what is compared of a path.csv."""
    return Motion(
        table["t"].to_numpy(),
        table[["x", "y"]].to_numpy(),
        table["yaw"].to_numpy(),
        table[[f"normal{leg}" for leg in LEGS]].fillna(0.0).to_numpy(),
    )


def angles_on_file(table: pd.DataFrame) -> Array:
    """Return the leg angles of a path.csv, shape (n, 6) [rad]."""
    return table[[f"theta{leg}" for leg in LEGS]].to_numpy()


def compare(program: Program, folder: Path, finer: bool = False) -> Compared:
    """Walk a program by the command and by the engine, and compare."""
    table = walk_by_command(program, folder)
    t, theta = table["t"].to_numpy(), angles_on_file(table)
    friction, end = Friction(program.friction, 1e-3), float(t[-1])

    def engine(settings: Settings) -> tuple[Motion, float]:
        """Return the motion by the engine, and how well it kept the leg angles [rad]."""
        path = walk(ROBOT, t, theta, friction, settings=settings)
        return motion_of(path), path.angle_error

    truth, angle_error = engine(SETTINGS)
    legs = steered_wrongly(program, folder)
    fine = motion_by_model(program.friction, SampledReference(t, theta), end, FINE)
    wrong = motion_by_model(program.friction, legs.reference(), legs.end, DynamicsOptions())
    return Compared(
        program,
        end,
        whole_turn(truth),
        agreement(motion_on_file(table), truth),
        agreement(fine, truth),
        agreement(wrong, truth),
        angle_error,
        tuple(agreement(engine(each)[0], truth) for each in refined()) if finer else (),
    )


def print_compared(all_compared: Sequence[Compared]) -> None:
    """Print each program's row, then median and worst, and what the planted error does."""
    head = ("program", "friction", "time", "turned", "path", "heading", "contacts agree")
    head += ("in steps of 0.25 ms: path", "heading", "steering term 5 % off: path", "heading")
    finer = bool(all_compared[0].refined)
    head += ("engine, half the step", "contacts four times as stiff") if finer else ()
    print_table(head, *(_row(each) for each in all_compared))
    for what in ("errors", "converged", "planted"):
        print(f"{_WORDS[what]}: {_summary([getattr(each, what) for each in all_compared])}")
    kept = max(each.angle_error for each in all_compared)
    print(f"legs kept to {np.degrees(kept):.1g}°")


def _summary(errors: Sequence[Agreement]) -> str:
    """Return median and worst of path and heading, and whether all are within what is allowed."""
    words = []
    for what in ("path", "heading"):
        each = 100 * np.array([getattr(one, what) for one in errors])
        words.append(f"{what} median {np.median(each):.2f} %, worst {each.max():.2f} %")
    beyond = sum(fails(one) for one in errors)
    verdict = "all within" if beyond == 0 else f"{beyond} of {len(errors)} beyond"
    return f"{'; '.join(words)}; {verdict} {LIMITS}"


def fails(errors: Agreement) -> bool:
    """Return whether path or heading are further from the engine's than allowed."""
    return not (errors.path <= ALLOWED_PATH and errors.heading <= ALLOWED_HEADING)


def _row(one: Compared) -> tuple[str, ...]:
    """Return the cells of a program."""
    return (
        str(one.program.number),
        f"{one.program.friction:g}",
        f"{one.duration:.1f} s",
        f"{np.degrees(one.turned):.0f}°",
        f"{100 * one.errors.path:.2f} %",
        f"{100 * one.errors.heading:.2f} %",
        f"{100 * one.errors.contacts:.1f} %",
        *(
            f"{100 * error:.2f} %"
            for each in (one.converged, one.planted)
            for error in (each.path, each.heading)
        ),
        *(f"{100 * each.path:.2f} %" for each in one.refined),
    )


def main(arguments: list[str] | None = None) -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=int, default=20, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of the programs")
    parser.add_argument("--finer", action="store_true", help="refine the engine, too")
    parser.add_argument("--processes", type=int, default=2, help="at a time")
    parser.add_argument("--keep", type=Path, help="folder for programs and walks")
    asked = parser.parse_args(arguments)
    programs = [random_program(number, asked.seed) for number in range(1, asked.programs + 1)]
    all_compared = []
    with (
        tempfile.TemporaryDirectory() as scratch,
        ProcessPoolExecutor(asked.processes, get_context("spawn")) as pool,
    ):
        folder = asked.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for one in pool.map(compare, programs, repeat(folder), repeat(asked.finer)):
            print(*_row(one), sep="  ", file=sys.stderr, flush=True)
            all_compared.append(one)
    print_compared(all_compared)


if __name__ == "__main__":
    main()
