# SPDX-License-Identifier: MIT
"""Leg angles rebuilt from counts, against angles that are known (simulated).

Legs of gaits with two speeds, and of an independent engine's walks (reference data), are counted in
steps of several sizes at several rates, rebuilt, and drawn. The first table has the errors of the
mean motion, and how many of the true angles, at times between the samples, the draws' central 50
and 90 % hold. The second has what the counts do to a turning radius: each of the engine's walks is
walked by the project's model with the engine's friction, from the engine's angles and from counts
of 3.6 degrees at 100 Hz whose zero lies elsewhere each time, as that of a real encoder may. The
third has what encoders of 100 to 65536 counts a turn, and noise, do to the radius of three walks
where `predict` is left to find the counts or the noise, and the 90 % band of its draws.

Prints tables of `docs/validation.md`.

Usage: python -m benchmarks.accuracy.counted_angles [coverage | radii | found]
"""

import sys
from collections.abc import Callable, Iterator
from itertools import repeat

import numpy as np

from benchmarks.accuracy.engine_walks import SHARED, EngineWalk, radius, read_walk
from benchmarks.tables import print_table
from model.gait.buehler import buehler_reference
from model.gait.inexact_log import InexactLog
from model.gait.reference import LegReference, SampledReference
from model.leg_state import LegState
from model.predict import ModelSpread, predict_paths, walk_draws
from model.robot import GRAVITY
from model.slip.law import Array
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.traction import VelocityCoulomb
from zebro_lab.robot.leg_log import LegLog
from zebro_lab.walk.leg_angles import angles_from
from zebro_lab.walk.output_request import BandRequest
from zebro_lab.walk.path_band import offset_sd_deg

COUNTS = (0.05, 0.2, 0.5, 1.0, 2.0, 3.6)  # deg
RATES = (20.0, 50.0, 100.0, 200.0)  # Hz
DURATION, INNER, PLACES = 14.0, 0.5, 2000  # s; s left out at either end; times compared
DRAWS = 99
GAITS = 6  # with two speeds
ENGINE = (
    "tripod_s1.20_left_mu0.38_tc2", "tripod_s1.30_left_mu0.38_tc2_arc200real", "tetrapod_mu0.20_tc3"
)  # fmt: skip
ZEROS = 12  # of an encoder
TURNING = (
    "tripod_s1.10_left_mu0.38_tc2", "tripod_s1.30_right_mu0.38_tc2",
    "tripod_s1.30_left_mu0.38_tc2_arc200real",
)  # fmt: skip
TURNS = (100, 360, 1000, 1024, 1200, 2048, 4096, 8192, 16384, 65536)  # counts
NOISE = (5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3)  # rad
MIXED = ((1024, 5e-4), (4096, 5e-4))
BAND = 40  # draws
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
    log = InexactLog(t, step * np.round(truth(t) / step), step)
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
    log = InexactLog(one.log.t, STEP * np.round((one.log.theta + zero) / STEP), STEP)
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


def print_found() -> None:
    """Print what counts and noise that must be found first do to the radius of three walks."""
    rng = np.random.default_rng(1)
    walks = [one for one in engine_walks() if one.name in TURNING]
    rows = [("as they are", *(found_radius(one, one.log.theta, rng) for one in walks))]
    for turn in TURNS:
        step = 2 * np.pi / turn
        counted = [step * np.round(one.log.theta / step) for one in walks]
        cells = map(found_radius, walks, counted, repeat(rng))
        rows.append((f"{turn} counts a turn", *cells))
    for sd in NOISE:
        cells = []
        for one in walks:
            noise = rng.normal(0.0, sd, one.log.theta.shape)
            cells.append(found_radius(one, one.log.theta + noise, rng))
        rows.append((f"noise of {1e3 * sd:g} mrad", *cells))
    for turn, sd in MIXED:
        step, cells = 2 * np.pi / turn, []
        for one in walks:
            noisy = one.log.theta + rng.normal(0.0, sd, one.log.theta.shape)
            cells.append(found_radius(one, step * np.round(noisy / step), rng))
        rows.append((f"noise of {1e3 * sd:g} mrad in {turn} counts", *cells))
    print_table(("angles", *(one.name.removeprefix("tripod_") for one in walks)), *rows)


def found_radius(one: EngineWalk, theta: Array, rng: np.random.Generator) -> str:
    """Say by how much the radius from measured angles differs, and the draws' 90 % band [%]."""
    legs, _ = angles_from(LegLog(SampledReference(one.log.t, theta), "sim:engine", ()), 0.0)
    rebuilt = legs.smooth() if isinstance(legs, InexactLog) else legs
    known = walked_radius(one, one.log)
    off = 100 * (walked_radius(one, rebuilt) / known - 1)
    offset = np.radians(offset_sd_deg(BandRequest(BAND), legs))
    state = LegState.of_prior(BAND, offset_sd=float(offset), rng=rng)
    table = VelocityCoulomb(one.friction).table(weight=one.robot.mass * GRAVITY)
    t = np.arange(0.0, one.duration, 0.05)
    paths = predict_paths(
        walk_draws(one.robot, legs, [table], state, rng=rng), t,
        state=state, error=ModelSpread(), rng=rng, options=DynamicsOptions(dt=0.005),
    )  # fmt: skip
    each = [radius(t, states[:, :2], states[:, 2], one.period) for states in paths.states]
    low, high = np.sort(100 * (1 / (known * np.quantile(1 / np.array(each), [0.05, 0.95])) - 1))
    return f"{off:+.2f} ({low:+.1f} to {high:+.1f})"


PARTS = {"coverage": print_coverage, "radii": print_radii, "found": print_found}


def main() -> None:
    """Print the tables asked for; all without a name."""
    for part in sys.argv[1:] or PARTS:
        PARTS[part]()


if __name__ == "__main__":
    main()
