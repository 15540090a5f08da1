# SPDX-License-Identifier: MIT
"""Leg angles rebuilt from counts, against angles that are known (simulated).

Legs of gaits with two speeds, and of an independent engine's walks (reference data), are counted in
steps of several sizes at several rates, rebuilt, and drawn. The first table has the errors of the
mean motion, and how many of the true angles, at times between the samples, the draws' central 50
and 90 % hold. The second has what the counts do to a turning radius: each of the engine's walks is
walked by the project's model with the engine's friction, from the engine's angles and from counts
of 3.6 degrees at 100 Hz whose zero lies elsewhere each time, as that of a real encoder may.

Prints tables of `docs/validation.md`.

Usage: python -m benchmarks.accuracy.counted_angles [coverage | radii]
"""

import sys
from collections.abc import Callable, Iterator

import numpy as np

from benchmarks.accuracy.engine_walks import SHARED, EngineWalk, radius, read_walk
from benchmarks.tables import print_table
from model.gait.buehler import buehler_reference
from model.gait.quantised import QuantisedLog
from model.gait.reference import LegReference, SampledReference
from model.robot import GRAVITY
from model.slip.law import Array
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.traction import VelocityCoulomb

COUNTS = (0.05, 0.2, 0.5, 1.0, 2.0, 3.6)  # deg
RATES = (20.0, 50.0, 100.0, 200.0)  # Hz
DURATION, INNER, PLACES = 14.0, 0.5, 2000  # s; s left out at either end; times compared
DRAWS = 99
GAITS = 6  # with two speeds
ENGINE = (
    "tripod_s1.20_left_mu0.38_tc2", "tripod_s1.30_left_mu0.38_tc2_arc200real", "tetrapod_mu0.20_tc3"
)  # fmt: skip
ZEROS = 12  # of an encoder
STEP, STRAIGHT = np.radians(3.6), 5.0  # of an encoder [rad]; a radius beyond is a straight line's

Angles = Callable[[Array], Array]


def two_speeds(rng: np.random.Generator) -> Angles:
    """Return the angles of a gait of random cycle, stance and phase, with two speeds."""
    cycle, began = rng.uniform(1.2, 3.5), rng.uniform(0.0, 3.5)
    gait = buehler_reference(
        rng.uniform(-1.1, -0.4), rng.uniform(0.4, 1.1),
        ground_time=cycle * rng.uniform(0.4, 0.6), cycle_time=cycle,
    )  # fmt: skip
    return lambda t: gait.angles(t + began)


def engine_walks() -> Iterator[EngineWalk]:
    """Read the engine's walks, in the order of their names."""
    yield from map(read_walk, sorted((SHARED / "virtual-world" / "walks").glob("*.json")))


def judged(truth: Angles, step: float, rate: float, rng: np.random.Generator) -> Array:
    """Compare rebuilt angles with true ones: squared error [rad2], held by 50 and by 90 %, (3,)."""
    t = np.arange(0.0, DURATION, 1 / rate)
    log = QuantisedLog(t, step * np.round(truth(t) / step), step)
    at = np.sort(rng.uniform(INNER, DURATION - INNER, PLACES))
    known = truth(at)
    below = sum((log.smooth(rng).angles(at) < known for _ in range(DRAWS)), np.zeros(known.shape))
    within = np.abs(2 * (below + 0.5) / (DRAWS + 1) - 1)
    error = log.smooth().angles(at) - known
    return np.array(
        [float(np.mean(each)) for each in (error**2, within < 0.5, within < 0.9)], dtype=float
    )


def print_coverage() -> None:
    """Print errors and coverage of rebuilt angles, by legs, count and rate."""
    rng = np.random.default_rng(7)
    legs: dict[str, list[Angles]] = {"two speeds": [two_speeds(rng) for _ in range(GAITS)]}
    for one in engine_walks():
        if one.name in ENGINE:
            legs[one.name.removeprefix("tripod_").replace("_tc2", "")] = [one.log.angles]
    head = ("legs", "count [deg]", *(f"{rate:.0f} Hz: rms [deg], 50 %, 90 %" for rate in RATES))
    rows = []
    for name, motions in legs.items():
        for step in COUNTS:
            cells = []
            for rate in RATES:
                one = np.mean([judged(m, np.radians(step), rate, rng) for m in motions], axis=0)
                cells.append(f"{np.degrees(np.sqrt(one[0])):.3f}, {one[1]:.0%}, {one[2]:.0%}")
            rows.append((name, f"{step:g}", *cells))
    print_table(head, *rows)


def walked_radius(one: EngineWalk, legs: LegReference) -> float:
    """Walk by our model from leg angles, with the engine's friction; return the radius [m]."""
    table = VelocityCoulomb(one.friction).table(weight=one.robot.mass * GRAVITY)
    options = DynamicsOptions(dt=0.0025)
    path = walk(one.robot, legs, table, duration=one.duration, options=options)
    return radius(path.t, path.position[:, :2], path.yaw, one.period)


def counted_from(one: EngineWalk, zero: float) -> SampledReference:
    """Rebuild a walk's angles from counts of an encoder whose zero lies at an angle [rad]."""
    log = QuantisedLog(one.log.t, STEP * np.round((one.log.theta + zero) / STEP), STEP)
    rebuilt = log.smooth()
    return SampledReference(rebuilt.t, rebuilt.theta - zero)


def print_radii() -> None:
    """Print by how much counts move the radius of each walk that turns."""
    rng = np.random.default_rng(0)
    rows, every = [], []
    for one in engine_walks():
        known = walked_radius(one, one.log)
        if abs(known) > STRAIGHT:
            continue
        counted = [counted_from(one, zero) for zero in rng.uniform(0, STEP, ZEROS)]
        off = 100 * (np.array([walked_radius(one, each) for each in counted]) / known - 1)
        every.append(off)
        rows.append((one.name, *_of(off)))
    print_table(
        ("walk", "mean [%]", "rms [%]", "largest [%]"), *rows, ("all", *_of(np.concatenate(every)))
    )


def _of(off: Array) -> tuple[str, str, str]:
    return f"{off.mean():+.2f}", f"{np.sqrt(np.mean(off**2)):.2f}", f"{np.abs(off).max():.2f}"


PARTS = {"coverage": print_coverage, "radii": print_radii}


def main() -> None:
    """Print the tables asked for; both without a name."""
    for part in sys.argv[1:] or PARTS:
        PARTS[part]()


if __name__ == "__main__":
    main()
