# SPDX-License-Identifier: MIT
"""Our engine against walks of the reference data's engine, and against itself, finer and harder.

The walks (simulated, `ZEBRO_LAB_SHARED`) were made by MuJoCo with the same laws but other code.
Prints a table of walks, and of what finer steps and harder contacts change.

The tetrapod's path is not converged in stiffness: legs that stand four at a time share the load as
their contacts yield, and it goes on changing (0.7, 0.9 and 3.1 % from the reference with contact
times of 4, 2 and 1 ms). Its agreement says no more than that stiffnesses are alike.

Usage: python -m benchmarks.accuracy.rigid_engine.references [--finer]
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.accuracy import engine_walks
from benchmarks.accuracy.rigid_engine.agreement import Motion, agreement, motion_of
from benchmarks.accuracy.rigid_engine.stepping import Friction
from benchmarks.accuracy.rigid_engine.walking import SETTINGS, EnginePath, Settings, walk
from benchmarks.tables import print_table

LEGS = range(1, 7)


def reference(one: engine_walks.EngineWalk) -> Motion:
    """Return the walk of the reference data; its loads are means of the last 5 ms."""
    truth = one.truth
    return Motion(
        truth["t"].to_numpy(),
        truth[["x", "y"]].to_numpy(),
        truth["yaw"].to_numpy(),
        truth[[f"fn{i}" for i in LEGS]].to_numpy(),
    )


def by_engine(one: engine_walks.EngineWalk, settings: Settings = SETTINGS) -> EnginePath:
    """Walk the log of a reference walk by our engine."""
    theta = one.truth[[f"th{i}" for i in LEGS]].to_numpy()
    friction = Friction(one.friction, 1e-3)
    return walk(one.robot, one.truth["t"].to_numpy(), theta, friction, settings=settings)


def figures(file: Path, finer: bool = False) -> tuple[str, ...]:
    """Return a row: errors against the reference, and of the engine against itself refined."""
    one = engine_walks.read_walk(file)
    path = by_engine(one)
    ours, theirs = motion_of(path), reference(one)
    errors = agreement(ours, theirs)
    radii = [engine_walks.radius(each.t, each.xy, each.yaw, one.period) for each in (ours, theirs)]
    straight = abs(radii[1]) > engine_walks.STRAIGHT
    cells = [
        one.name,
        f"{100 * errors.path:.2f} %",
        "straight" if straight else f"{100 * (radii[0] / radii[1] - 1):+.2f} %",
        f"{100 * errors.contacts:.1f} %",
        f"{np.degrees(path.angle_error):.1g}°",
    ]
    if finer:
        for settings in refined():
            change = agreement(motion_of(by_engine(one, settings)), ours)
            cells.append(f"{100 * change.path:.3f} %")
    return tuple(cells)


def refined() -> tuple[Settings, Settings]:
    """Return settings of half the step, and of contacts four times as stiff."""
    return (
        replace(SETTINGS, dt=0.5 * SETTINGS.dt),
        replace(SETTINGS, contact_time=0.5 * SETTINGS.contact_time),
    )


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--finer", action="store_true", help="refine step and contacts, too")
    finer = parser.parse_args(arguments).finer
    files = sorted((engine_walks.SHARED / "virtual-world" / "walks").glob("*.json"))
    if not files:
        raise SystemExit(
            f"no walks under {engine_walks.SHARED}; set ZEBRO_LAB_SHARED to the reference data"
        )
    head = ("walk", "path", "radius", "contacts agree", "angles kept to")
    head += ("half the step", "contacts four times as stiff") if finer else ()
    with ProcessPoolExecutor(2, get_context("spawn")) as processes:
        rows = list(processes.map(figures, files, [finer] * len(files)))
    print_table(head, *rows)


if __name__ == "__main__":
    main()
