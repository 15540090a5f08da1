# SPDX-License-Identifier: MIT
"""Random walking programs, walked by the command and by an engine that shares no code with it.

Each program is written to a file and walked by `zebro-lab walk PROGRAM`; the engine (group `bench`)
walks the leg angles of its path.csv. Programs change gaits, curve, turn on the spot, stand and walk
backwards. Compared are path and heading; walks of programs whose steering is 5 % off are compared
with the engine's walks of the right ones, to show that such an error would be seen.

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
from pathlib import Path

import numpy as np
import pandas as pd

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
from model.robot import N_LEGS, Robot
from model.slip.law import Array

ALLOWED_PATH, ALLOWED_HEADING = 0.015, 0.02  # of the length, of the whole turn
STEERING_ERROR = 0.95  # of the steering of curves and turns, planted
GAITS = (
    "tripod",
    "tetrapod",
    "{1,4,5} < {2,3,6}",
    "{1,4} < {2,5} < {3,6}",
    "{1,6} < {2,5} < {3,4}",
)
FRICTIONS = (0.2, 0.38, 0.7)
LEGS = range(1, N_LEGS + 1)
COMMAND = Path(sys.executable).with_name("zebro-lab")


@dataclass(frozen=True)
class Segment:
    """A segment of a program.

    Attributes:
        text: Its keys but the steering, in TOML.
        steering: Stance angle of inner over outer legs; 1 is straight [-].
    """

    text: str
    steering: float = 1.0

    def toml(self, share: float = 1.0) -> str:
        """Write the segment; a curve or a turn with a share of its steering."""
        steering = "" if self.steering == 1 else f"\nsteering = {share * self.steering:.4f}"
        return f"[[segment]]\n{self.text}{steering}\n"


@dataclass(frozen=True)
class Program:
    """A random program.

    Attributes:
        number: Its number.
        segments: Its segments.
        friction: Friction coefficient of the floor [-].
    """

    number: int
    segments: tuple[Segment, ...]
    friction: float

    def toml(self, share: float = 1.0) -> str:
        """Write program.toml; curves and turns with a share of their steering."""
        return "\n".join(segment.toml(share) for segment in self.segments)


@dataclass(frozen=True)
class Compared:
    """A program walked by the command and by the engine.

    Attributes:
        program: The program.
        duration: Time walked [s].
        turned: Changes of heading, left and right added [rad].
        errors: Of the command's path against the engine's.
        planted: The same with the steering off.
        angle_error: Largest departure of the engine's legs from their angles [rad].
        refined: Changes of the engine's walk with half the step, and with contacts four times as
            stiff; none unless asked for.
    """

    program: Program
    duration: float
    turned: float
    errors: Agreement
    planted: Agreement
    angle_error: float
    refined: tuple[Agreement, ...] = ()


def random_program(number: int, seed: int) -> Program:
    """Draw a program: a turn on the spot, a curve, a stand and two more segments, in any order."""
    rng = np.random.default_rng([seed, number])
    kinds = ["spot", "curve", "stand", *rng.choice(["straight", "curve", "backwards", "spot"], 2)]
    rng.shuffle(kinds)
    segments = tuple(_segment(str(kind), rng) for kind in kinds)
    return Program(number, segments, float(rng.choice(FRICTIONS)))


def _segment(kind: str, rng: np.random.Generator) -> Segment:
    """Draw a segment of a kind."""
    if kind == "stand":
        return Segment(f"stand = {rng.uniform(0.3, 1.5):.2f}")
    gait = str(rng.choice(GAITS))
    cycle = rng.uniform(1.2, 2.4) * (1.0 if gait in GAITS[::2][:2] else 1.4)
    keys = [f'gait = "{gait}"', f"cycle = {cycle:.3f}"]
    keys.append(f'direction = "{rng.choice(["left", "right"])}"')
    if kind == "spot":
        keys.append(f"until = {{ heading_deg = {rng.uniform(40.0, 110.0):.1f} }}")
        return Segment("\n".join(keys), -1.0)
    if kind == "backwards":
        keys.append("reverse = true")
    keys.append(f"until = {{ strides = {rng.integers(2, 4)} }}")
    steering = 1.0 if kind == "straight" else rng.uniform(0.3, 0.9)
    return Segment("\n".join(keys), float(steering))


def walk_by_command(program: Program, folder: Path, share: float = 1.0) -> pd.DataFrame:
    """Walk a program by the command and return the table of its path.csv."""
    file = folder / f"program_{program.number}_{share:g}.toml"
    file.write_text(program.toml(share))
    out = folder / file.stem
    command = [COMMAND, "walk", file, "--out", out]
    command += ["--slip", f"coulomb:{program.friction:g}:0.001"]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"walk {file.name} ended with {done.returncode}:\n{done.stderr}")
    return pd.read_csv(out / "path.csv")


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
    friction = Friction(program.friction, 1e-3, np.zeros((0, 5)))

    def engine(settings: Settings) -> tuple[Motion, float]:
        """Return the motion by the engine, and how well it kept the leg angles [rad]."""
        path = walk(Robot(), t, theta, friction, settings=settings)
        return motion_of(path), path.angle_error

    truth, angle_error = engine(SETTINGS)
    return Compared(
        program,
        float(t[-1]),
        whole_turn(truth),
        agreement(motion_on_file(table), truth),
        agreement(motion_on_file(walk_by_command(program, folder, STEERING_ERROR)), truth),
        angle_error,
        tuple(agreement(engine(each)[0], truth) for each in refined()) if finer else (),
    )


def print_compared(all_compared: Sequence[Compared]) -> None:
    """Print each program's row, then median and worst, and what the planted error does."""
    head = ("program", "friction", "time", "turned", "path", "heading", "contacts agree")
    head += ("steering 5 % off: path", "heading")
    finer = bool(all_compared[0].refined)
    head += ("engine, half the step", "contacts four times as stiff") if finer else ()
    print_table(head, *(_row(each) for each in all_compared))
    for what, allowed in (("path", ALLOWED_PATH), ("heading", ALLOWED_HEADING)):
        errors = np.array([getattr(each.errors, what) for each in all_compared])
        planted = np.array([getattr(each.planted, what) for each in all_compared])
        print(
            f"{what}: median {100 * np.median(errors):.2f} %, worst {100 * errors.max():.2f} %, "
            f"{(errors <= allowed).sum()} of {len(errors)} within {100 * allowed:g} %; with the "
            f"steering 5 % off median {100 * np.median(planted):.2f} %, "
            f"{(planted > allowed).sum()} beyond"
        )
    seen = [fails(each.planted) for each in all_compared]
    kept = max(each.angle_error for each in all_compared)
    print(f"planted errors seen: {sum(seen)} of {len(seen)}; legs kept to {np.degrees(kept):.1g}°")


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
        f"{100 * one.planted.path:.1f} %",
        f"{100 * one.planted.heading:.1f} %",
        *(f"{100 * each.path:.2f} %" for each in one.refined),
    )


def main(arguments: list[str] | None = None) -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=int, default=20, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of the programs")
    parser.add_argument("--finer", action="store_true", help="refine the engine, too")
    parser.add_argument("--keep", type=Path, help="folder for programs and walks")
    asked = parser.parse_args(arguments)
    programs = [random_program(number, asked.seed) for number in range(1, asked.programs + 1)]
    with tempfile.TemporaryDirectory() as scratch, ProcessPoolExecutor(2) as processes:
        folder = asked.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        print_compared(list(processes.map(compare, programs, repeat(folder), repeat(asked.finer))))


if __name__ == "__main__":
    main()
