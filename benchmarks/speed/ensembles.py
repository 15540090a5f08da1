# SPDX-License-Identifier: MIT
"""Speed of ensembles of logs beside their error, and how time and memory grow.

Prints the tables of the section "Ensembles of a log" of docs/benchmarks.md. Everything is
simulated: leg angles of our own gaits, every draw with its own Magic Formula and leg offsets as in
`benchmarks.speed.walking`.

Usage: python -m benchmarks.speed.ensembles
"""

import multiprocessing
import resource
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from benchmarks.machine import describe_machine
from benchmarks.speed.walking import CYCLE, ROBOT, gait, make_draws
from benchmarks.tables import print_table
from model.gait import LegReference, SampledReference, tetrapod_reference
from model.gait.notation import TRIPOD
from model.gait.program import cycle_gait
from model.slip.law import Array
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import WalkDraw, planar_walk, walk_ensemble
from model.walk.program import Segment, Until, lay_out
from zebro_lab.workers.threads import Threads

LOG_RATE = 100.0  # Hz
DURATION = 30.0  # s
COMPARED, REPEATS = 32, 5  # draws whose ends are compared; the fastest repeat counts
CONVERGED = 0.00025  # s
STEPS = (0.005, 0.0025, 0.001, 0.0005)  # s
GROWN_STEP = 0.005  # s, of the tables of growth
DRAWS = (250, 500, 1000, 2000)
LENGTHS = (15.0, 30.0, 60.0, 120.0)  # s
SEGMENTS = (4, 8, 16, 32)
LENGTH_DRAWS, SEGMENT_DRAWS = 500, 100
HEADING = np.radians(30.0)  # of every second segment


def gaits() -> dict[str, LegReference]:
    """Return the tripod of the walking benchmark, and a tetrapod of the same cycle."""
    tetrapod = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=CYCLE)
    return {"tripod": gait(), "tetrapod": tetrapod}


def log_of(reference: LegReference, duration: float) -> SampledReference:
    """Sample leg angles as a log does."""
    t = np.arange(0.0, duration + 1 / LOG_RATE, 1 / LOG_RATE)
    return SampledReference(t, reference.angles(t))


def used(work: Callable[[], object], *, repeats: int) -> float:
    """Return the least processor time of all threads that a function takes in some repeats [s]."""
    least = np.inf
    for _ in range(repeats):
        began = time.process_time()
        work()
        least = min(least, time.process_time() - began)
    return float(least)


def ends(draws: list[WalkDraw], dt: float) -> tuple[Array, Array]:
    """Walk draws at a step; return their last positions, (n, 2), and path lengths, (n,) [m]."""
    t = np.linspace(0.0, DURATION, 301)
    position = walk_ensemble(draws, t, options=DynamicsOptions(dt=dt)).poses.position
    return position[:, -1], np.linalg.norm(np.diff(position, axis=1), axis=2).sum(axis=1)


def rate_rows(name: str, reference: LegReference) -> list[tuple[str, ...]]:
    """Return a row for every step: errors of the ends, and simulated time per processor time."""
    draws, _ = make_draws(COMPARED, log_of(reference, DURATION))
    converged, length = ends(draws, CONVERGED)
    rows = []
    for dt in STEPS:
        options = DynamicsOptions(dt=dt)
        found, _ = ends(draws, dt)
        error = np.linalg.norm(found - converged, axis=1) / length
        shared = np.linalg.norm((found - converged).mean(axis=0)) / length.mean()
        together = used(lambda dt=dt: ends(draws, dt), repeats=REPEATS)
        alone = used(
            lambda options=options: planar_walk(draws[0], duration=DURATION, options=options),
            repeats=REPEATS,
        )
        rows.append(
            (
                name, f"{1000 * dt:g}", f"{100 * float(shared):.2f} %",
                f"{100 * float(np.median(error)):.2f} %", f"{100 * float(error.max()):.2f} %",
                f"{COMPARED * DURATION / together:,.0f}", f"{DURATION / alone:,.0f}",
            )
        )  # fmt: skip
    return rows


def time_rates() -> None:
    """Print rates and errors of both gaits."""
    head = (
        "log of a", "step (ms)", "mean end off", "median end off", "worst end off",
        "ensemble: simulated s per processor s", "one walk",
    )  # fmt: skip
    print_table(head, *(row for each in gaits().items() for row in rate_rows(*each)))
    print(
        f"{COMPARED} draws of {DURATION:g} s. Ends are compared with those at "
        f"{1000 * CONVERGED:g} ms, in parts of the path. Fastest of {REPEATS}.\n"
    )


def grown(kind: str, draws: int, length: float, segments: int) -> tuple[float, float, float]:
    """Walk an ensemble; return wall and processor time [s], and the process's peak memory [MB].

    Args:
        kind: "log" of a tripod, or "program".
        draws: Number of draws.
        length: Duration of a log [s].
        segments: Number of segments of a program, straight ones and turns to a heading in turn.
    """
    walk_ensemble(make_draws(2, log_of(gait(), 1.0))[0], np.array([0.1]))  # loads compiled code
    began, before = time.perf_counter(), time.process_time()
    options = DynamicsOptions(dt=GROWN_STEP)
    if kind == "log":
        made, _ = make_draws(draws, log_of(gait(), length))
    else:
        half = 0.5 * CYCLE
        straight, spot = (
            cycle_gait(TRIPOD, ground_time=half, flight_time=half, steering=each)
            for each in (1.0, -1.0)
        )
        one = Segment(straight, Until(strides=2)), Segment(spot, Until(heading=HEADING))
        plan = [one[i % 2] for i in range(segments)]
        law = make_draws(1, gait())[0][0].table
        legs, _ = lay_out(plan, ROBOT, law, options=options)
        length, made = legs.end, make_draws(draws, legs.reference())[0]
    t = np.linspace(0.0, length, max(2, round(10 * length) + 1))
    walk_ensemble(made, t, options=options, mapper=Threads(2))
    took = time.perf_counter() - began, time.process_time() - before
    return *took, peak_memory()


def peak_memory() -> float:
    """Return the largest memory that this process has held so far [MB]."""
    status = Path("/proc/self/status")
    if status.exists():  # rusage counts what the parent held when it made this process
        held = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM"))
        return int(held.split()[1]) / 1000
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000


def growth_row(kind: str, draws: int, length: float, segments: int) -> tuple[str, ...]:
    """Measure an ensemble in a process of its own; return its row."""
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn) as pool:
        wall, processor, memory = pool.submit(grown, kind, draws, length, segments).result()
    shown = (f"{length:g}", "") if kind == "log" else ("", f"{segments}")
    return (kind, f"{draws:,}", *shown, f"{wall:.1f}", f"{processor:.1f}", f"{memory:.0f}")


def time_growth() -> None:
    """Print time and memory over draws, over the length of a log, and over a program's segments."""
    plans = [("log", n, DURATION, 0) for n in DRAWS]
    plans += [("log", LENGTH_DRAWS, length, 0) for length in LENGTHS]
    plans += [("program", SEGMENT_DRAWS, 0.0, n) for n in SEGMENTS]
    head = (
        "ensemble of a", "draws", "length (s)", "segments", "seconds", "processor seconds",
        "peak memory (MB)",
    )  # fmt: skip
    print_table(head, *(growth_row(*plan) for plan in plans))
    print(
        "Each in a process of its own, with the tables of the law, and a program's laying out, in "
        f"steps of {1000 * GROWN_STEP:g} ms on 2 threads. Memory is that of the whole process.\n"
    )


def main() -> None:
    """Print both tables."""
    print(f"Machine: {describe_machine()}.\n")
    time_rates()
    time_growth()


if __name__ == "__main__":
    main()
