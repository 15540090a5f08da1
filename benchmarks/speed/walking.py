# SPDX-License-Identifier: MIT
"""Time the walking model beside MuJoCo, in one run: `make bench`.

Prints the tables of the chapter "Walking" of docs/benchmarks.md. Everything is simulated: the
source's robot, tripod, steering factor 1.3, touchdown at 50 degrees, two seconds a cycle.
"""

import multiprocessing
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.machine import describe_machine
from benchmarks.tables import print_table
from model.arrays import Array
from model.gait import LegReference, SampledReference, tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import GRAVITY, Robot
from model.slip.magic_formula import MagicFormula
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.ensemble import WalkDraw, walk_ensemble
from model.walk.path import turning_radius
from model.walk.traction import TractionTable, VelocityCoulomb, law_table

SEED = 2020
ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
FRICTION = 0.38
THESIS_VALUES = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])  # K, C, mu, x
CYCLE = 2.0  # s
DURATION = 30.0  # s
SMALL_STEP = 0.00025  # s: the radius that others are compared with
STEPS = (0.001, 0.002, 0.005, 0.008)  # s, the default first
LARGE_STEP = 0.005  # s, for ensembles and beside MuJoCo
REPEATS, ENSEMBLE_REPEATS = 7, 3
THREADS = 2
DRAWS, DURATIONS = (250, 500, 1000), (10.0, 30.0, 120.0)
LAW_SPREAD = np.array([0.05, 0.0, 0.05, 0.05])  # standard deviations of logarithms
LEG_OFFSET = np.radians(1.0)  # about that of angles rounded to 3.6 degrees
LOG_RATE = 100.0  # Hz
TARGET_RATE, TARGET_SECONDS = 500.0, 10.0


@dataclass(frozen=True)
class Took:
    """Medians over repeats: wall time, and processor time of all threads [s]."""

    wall: float
    processor: float


def timed(work: Callable[[], object], *, repeats: int) -> Took:
    """Time a function that has run once before."""
    took = []
    for _ in range(repeats):
        began, used = time.perf_counter(), time.process_time()
        work()
        took.append((time.perf_counter() - began, time.process_time() - used))
    return Took(*(float(x) for x in np.median(took, axis=0)))


@contextmanager
def one_core() -> Iterator[None]:
    """Stay on one core, where the system lets a process choose."""
    if not hasattr(os, "sched_setaffinity"):
        print("This system pins no process to a core; MuJoCo and ours still use one thread.\n")
        yield
        return
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(allowed)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, allowed)


def gait() -> LegReference:
    """Return the tripod that is walked."""
    return tripod_reference(tripod_angles(np.radians(50.0), 1.3), CYCLE)


def laws() -> dict[str, TractionTable]:
    """Tabulate both friction laws."""
    magic_formula = law_table(MagicFormula("peak"), THESIS_VALUES, weight=WEIGHT)
    coulomb = VelocityCoulomb(FRICTION).table(weight=WEIGHT)
    return {f"Coulomb, mu {FRICTION}": coulomb, "Magic Formula of the thesis": magic_formula}


def radius(law: TractionTable, dt: float) -> float:
    """Compute the turning radius over whole cycles, the first one left out [m]."""
    path = walk(ROBOT, gait(), law, duration=7 * CYCLE, options=DynamicsOptions(dt=dt))
    ends = [round(CYCLE / dt), len(path.t) - 1]
    return turning_radius(path.position[ends, :2], path.yaw[ends])


def first_walk() -> float:
    """Time a walk of one step: compiling, or loading what was compiled, and little else [s]."""
    law = VelocityCoulomb(FRICTION).table(weight=WEIGHT)
    began = time.perf_counter()
    walk(ROBOT, gait(), law, duration=0.01)
    return time.perf_counter() - began


def time_compiling() -> None:
    """Time the first walk of a fresh process, with an empty cache and with the one it left."""
    before = os.environ.get("NUMBA_CACHE_DIR")
    spawn = multiprocessing.get_context("spawn")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["NUMBA_CACHE_DIR"] = folder
        try:
            seconds = []
            for _ in range(2):
                with ProcessPoolExecutor(1, mp_context=spawn) as pool:
                    seconds.append(pool.submit(first_walk).result())
        finally:
            del os.environ["NUMBA_CACHE_DIR"]
            if before is not None:
                os.environ["NUMBA_CACHE_DIR"] = before
    print(
        f"Compiling takes {seconds[0]:.1f} s, once after installing; a later process loads the "
        f"result in {seconds[1]:.2f} s. Neither is in the tables.\n"
    )


def time_single_walks() -> dict[float, float]:
    """Print the single walks of our model; return Coulomb's rates by step."""
    rows, coulomb_rates = [], {}
    for name, law in laws().items():
        converged = radius(law, SMALL_STEP)
        for dt in STEPS:
            options = DynamicsOptions(dt=dt)

            def work(law: TractionTable = law, options: DynamicsOptions = options) -> object:
                return walk(ROBOT, gait(), law, duration=DURATION, options=options)

            work()
            took, r = timed(work, repeats=REPEATS), radius(law, dt)
            rows.append(
                (
                    name, f"{1000 * dt:g}", f"{r:.4f}", f"{100 * (r / converged - 1):+.2f} %",
                    f"{DURATION / took.wall:,.0f}", f"{DURATION / took.processor:,.0f}",
                )
            )  # fmt: skip
            if law.by_velocity:
                coulomb_rates[dt] = DURATION / took.processor
    head = (
        "ours, one walk of 30 s", "step (ms)", "radius (m)", "from converged",
        "simulated s per wall s", "per processor s",
    )  # fmt: skip
    print_table(head, *rows)
    print(
        "A walk is all of it: standing up, leg angles, every step with the forces on every leg. "
        f"Converged is the radius at {1000 * SMALL_STEP:g} ms. Medians of {REPEATS}.\n"
    )
    return coulomb_rates


def time_mujoco(our_rates: dict[float, float]) -> None:
    """Print MuJoCo's step study and its fastest set-up beside our rate."""
    try:
        from benchmarks.speed import walking_mujoco as peer
    except ImportError as error:
        print(f"No tables for MuJoCo: {error}.\n")
        return
    reference = gait()
    studies = peer.all_studies(ROBOT, reference, FRICTION)
    rows = []
    for study in studies:
        one = peer.largest_step(study)
        name = peer.describe(one.setup)
        rows.append(
            (
                name, f"{1000 * one.setup.dt:g}", f"{one.radius:.4f}", f"{study[0].radius:.4f}",
                f"{one.processor:,.0f}",
            )
        )  # fmt: skip
    head = ("MuJoCo, set-up", "step (ms)", "radius (m)", "converged (m)", "per processor s")
    print_table(head, *rows)
    print(
        f"Each at the largest step whose radius is within {100 * peer.ALLOWED:g} % of the one at "
        f"{1000 * peer.STEPS[0]:g} ms. The study of the fastest:\n"
    )
    best = studies[0]
    print_table(
        ("step (ms)", "radius (m)", "from converged", "per processor s"),
        *(
            (
                f"{1000 * one.setup.dt:g}", f"{one.radius:.4f}",
                f"{100 * peer.departure(best, one):+.2f} %", f"{one.processor:,.0f}",
            )
            for one in best
        ),
    )  # fmt: skip
    chosen = peer.largest_step(best).setup
    final = peer.run(ROBOT, reference, FRICTION, chosen, duration=DURATION, repeats=REPEATS)
    print(
        f"At its fastest (MuJoCo {peer.mujoco.__version__}, {peer.describe(chosen)}, "
        f"{1000 * chosen.dt:g} ms) the walk of {DURATION:g} s runs at "
        f"{final.wall:,.0f} simulated seconds per wall second, {final.processor:,.0f} per "
        f"processor second; leg angles are kept to {np.degrees(final.angle_error):.3f} degrees. "
        f"Only the rollout is timed. Ours with Coulomb is "
        f"{our_rates[LARGE_STEP] / final.processor:.1f} times as fast at {1000 * LARGE_STEP:g} ms "
        f"and {our_rates[STEPS[-1]] / final.processor:.1f} times at {1000 * STEPS[-1]:g} ms, its "
        "own largest step by the same rule; by processor time.\n"
    )


def draw_values(n: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw parameters of the law, shape (n, 4), and leg offsets, shape (n, 6) [rad]."""
    values = THESIS_VALUES * np.exp(LAW_SPREAD * rng.standard_normal((n, 4)))
    return values, LEG_OFFSET * rng.standard_normal((n, 6))


def make_draws(n: int, reference: LegReference) -> tuple[list[WalkDraw], Took]:
    """Make draws of law and legs; also return what tabulating the laws took."""
    values, offsets = draw_values(n, np.random.default_rng(SEED))
    tables: list[TractionTable] = []

    def tabulate() -> None:
        tables[:] = [law_table(MagicFormula("peak"), row, weight=WEIGHT) for row in values]

    took = timed(tabulate, repeats=1)
    draws = [
        WalkDraw(replace(ROBOT, leg_offset=offset), reference, law)
        for offset, law in zip(offsets, tables, strict=True)
    ]
    return draws, took


def ensemble_row(name: str, n: int, duration: float, reference: LegReference) -> tuple[str, ...]:
    """Time an ensemble; return its row."""
    draws, tables = make_draws(n, reference)
    t = np.linspace(0.0, duration, 301)
    options = DynamicsOptions(dt=LARGE_STEP)
    with ThreadPoolExecutor(THREADS) as threads:
        took = timed(
            lambda: walk_ensemble(draws, t, options=options, executor=threads),
            repeats=ENSEMBLE_REPEATS,
        )
    both = tables.wall + took.wall
    return (
        name, f"{n:,}", f"{duration:g}", f"{tables.wall:.1f}", f"{took.wall:.1f}", f"{both:.1f}",
        f"{tables.processor + took.processor:.1f}", f"{n * duration / both:,.0f}",
    )  # fmt: skip


def logged(reference: LegReference) -> SampledReference:
    """Sample a gait, as a log of leg angles holds it."""
    t = np.arange(0.0, DURATION + 1 / LOG_RATE, 1 / LOG_RATE)
    return SampledReference(t, reference.angles(t))


def time_ensembles() -> None:
    """Print what ensembles take, by draws, duration and kind of reference."""
    tripod = gait()
    tetrapod = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    plans = [("tripod", n, DURATION, tripod) for n in DRAWS]
    plans += [("tripod", DRAWS[-1], d, tripod) for d in DURATIONS if d != DURATION]
    plans += [("tripod, log of leg angles, 100 Hz", DRAWS[-1], DURATION, logged(tripod))]
    plans += [("tetrapod", DRAWS[-1], DURATION, tetrapod)]
    plans += [("tetrapod, log of leg angles, 100 Hz", DRAWS[-1], DURATION, logged(tetrapod))]
    head = (
        "ensemble, 2 threads, steps of 5 ms", "draws", "walk (s)", "tables (s)", "walks (s)",
        "both (s)", "processor (s)", "simulated s per wall s",
    )  # fmt: skip
    print_table(head, *(ensemble_row(*plan) for plan in plans))
    print(
        "Every draw has its own Magic Formula (5 % in slope, grip and load dependence, tabulated "
        "once, on one thread) and its own leg offsets (1 degree each). Walks are medians of "
        f"{ENSEMBLE_REPEATS}. Targets: {TARGET_SECONDS:g} s for 1,000 draws of {DURATION:g} s, "
        f"{TARGET_RATE:g} simulated seconds per wall second for one walk on one core.\n"
    )


def main() -> None:
    """Print all tables of walking."""
    began = time.perf_counter()
    print(f"Machine: {describe_machine()}.\n")
    print("## Walking\n")
    time_compiling()
    with one_core():
        time_mujoco(time_single_walks())
    time_ensembles()
    load = os.getloadavg()[0]
    print(
        f"The walking benchmark took {time.perf_counter() - began:.0f} s; load average after it "
        f"{load:.1f}."
    )


if __name__ == "__main__":
    main()
