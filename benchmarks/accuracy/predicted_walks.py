# SPDX-License-Identifier: MIT
"""Walks of an independent engine predicted from what other walks say (simulated).

Every walk of the reference data becomes what a lab would have: leg angles counted in steps of 3.6
degrees, and a track of a pose every two seconds with a tracker's noise. Two walks of a floor inform
the fit; each other walk of that floor is predicted from its leg angles and its first tracked pose,
which is not scored, and judged by twenty tracks of other noise: a few poses behind one start may
well lie all within a band or all without. A walk by legs of another arc shares the floor with them,
not the legs. Then one leg is off by five degrees in one walk, and its log does not know: such walks
are made by the engine of `datasets/walk-sim`, which needs MuJoCo (the group `bench`).

Prints the tables of `docs/validation.md`.

Usage: python -m benchmarks.accuracy.predicted_walks CALIBRATION [--exact] [PART ...]

CALIBRATION is the folder that `calibrate-slip` made of the reference data's simulated rig. PART is
half-circles, other-legs, floors, wrong-leg, wrong-leg-imu (the same walks, with roll and pitch by
an IMU), straight (one of the half-circles' walks), tilt (roll and pitch alone) or
fast-walk (of half-circles the one of one second a cycle, by few draws), all of them where none is
named; with a number, as half-circles:0, one of its fits. With --exact leg angles are the engine's
instead of counted. The engine's walks are kept in ZEBRO_LAB_SCRATCH, or where temporary files are.
"""

import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from unittest import mock

import numpy as np

from benchmarks.accuracy.lab_walks import Bench, Scored, short
from model.bayes.walks import fit, modes
from model.bayes.walks.misfit import middle
from model.bayes.walks.posterior import WalkPosterior
from model.bayes.walks.tilt import SD, MeasuredTilt, TiltMisfit
from model.robot import GRAVITY
from model.walk.dynamics import DynamicsOptions
from model.walk.ensemble import WalkDraw, walk_ensemble

FIRST = "tripod_s1.10_left_mu0.38_tc2"
HALF_CIRCLES = (
    "tripod_s1.00_left_mu0.38_tc2", "tripod_s1.10_left_mu0.38_tc1", FIRST,
    "tripod_s1.20_left_mu0.38_tc2", "tripod_s1.30_right_mu0.38_tc2",
)  # fmt: skip
OTHER_LEGS = ("tripod_s1.10_left_mu0.38_tc2_arc200ideal", "tripod_s1.30_left_mu0.38_tc2_arc200real")
SLIPPERY = ("tripod_s1.20_left_mu0.20_tc2", "tetrapod_mu0.20_tc3")
ROUGH = "tripod_s1.20_left_mu0.70_tc2"
WRONG = ((2, 5.0), (3, 5.0), (0, 5.0), (2, -5.0))  # index of a leg, by how much it is off [deg]


def half_circles(bench: Bench, fits: Sequence[int] = range(5)) -> Iterator[Scored]:
    """Fit each walk and the next in the list; predict the other three."""
    n = len(HALF_CIRCLES)
    for i in fits:
        names = [HALF_CIRCLES[i], HALF_CIRCLES[(i + 1) % n]]
        posterior = bench.fit([bench.walk(name) for name in names]).posterior
        for name in (each for each in HALF_CIRCLES if each not in names):
            yield bench.score(posterior, bench.walk(name), name, " + ".join(map(short, names)))


def other_legs(bench: Bench, fits: Sequence[int] = range(1)) -> Iterator[Scored]:
    """Fit two walks; predict those of a robot with other legs on the same floor."""
    if 0 not in fits:
        return
    names = [FIRST, HALF_CIRCLES[3]]
    floor = bench.fit([bench.walk(name) for name in names]).posterior.of_floor_alone(
        rng=np.random.default_rng(3)
    )
    for name in OTHER_LEGS:
        yield bench.score(floor, bench.walk(name), name, " + ".join(map(short, names)))


def floors(bench: Bench, fits: Sequence[int] = range(3)) -> Iterator[Scored]:
    """On floors that were never on the rig: one walk informs, another is predicted."""
    pairs = (SLIPPERY, SLIPPERY[::-1], (FIRST, ROUGH))  # of the rough floor there is one walk alone
    for one, other in (pairs[i] for i in fits):
        posterior = bench.fit([bench.walk(one)]).posterior
        yield bench.score(posterior, bench.walk(other), other, short(one))


def wrong_leg(
    bench: Bench, fits: Sequence[int] = range(len(WRONG)), *, imu: bool = False
) -> Iterator[Scored]:
    """One leg is off in one walk of three, all of which inform; that walk is predicted."""
    for leg, degrees in (WRONG[i] for i in fits):
        name = bench.bent(leg, degrees)
        read = bench.with_imu if imu else bench.walk
        walks = [read(each) for each in (FIRST, HALF_CIRCLES[4], name)]
        posterior = bench.fit(walks).posterior
        print_found(posterior, f"leg {leg + 1} off by {degrees:+g} deg in {name} alone")
        yield bench.score(posterior, walks[2], name, "all three", index=2)


def straight(bench: Bench, fits: Sequence[int] = range(1)) -> Iterator[Scored]:
    """Predict the straight walk alone."""
    if 0 not in fits:
        return
    names = [FIRST, HALF_CIRCLES[3]]
    posterior = bench.fit([bench.walk(name) for name in names]).posterior
    walk = bench.walk(HALF_CIRCLES[0])
    informed_by = " + ".join(map(short, names))
    yield bench.score(posterior, walk, HALF_CIRCLES[0], informed_by)


def fast_walk(bench: Bench, fits: Sequence[int] = range(3)) -> Iterator[Scored]:
    """Predict the walk of one second a cycle alone, by few draws and no climbs of cases: quick."""
    few = mock.patch.multiple(fit, EFFORT=replace(fit.EFFORT, rounds=2))
    quick = mock.patch.multiple(modes, CLIMBED=0, SCANNED=np.radians(np.linspace(-12, 12, 5)))
    n = len(HALF_CIRCLES)
    for i in (2 + each for each in fits):
        names = [HALF_CIRCLES[i], HALF_CIRCLES[(i + 1) % n]]
        with few, quick:
            posterior = bench.fit([bench.walk(name) for name in names]).posterior
        fast = HALF_CIRCLES[1]
        yield bench.score(posterior, bench.walk(fast), fast, " + ".join(map(short, names)))


def tilt(bench: Bench, fits: Sequence[int] = range(1)) -> Iterator[Scored]:
    """Compare roll and pitch by the rig's law with the engine's, about their means."""
    print("\n| walk | rms roll, pitch | swing of the engine's |\n|---|---:|---:|")
    for name in bench.engine if 0 in fits else ():
        walk, seen = bench.walk(name), bench.engine[name].truth
        robot = walk.robot.robot
        table = bench.slip.traction_table(weight=robot.mass * GRAVITY)
        t = np.arange(0.0, walk.duration, 0.02)
        draw = WalkDraw(robot, middle(walk.legs), table)
        walked = walk_ensemble([draw], t, options=DynamicsOptions(dt=0.005), tilt=True)
        engine = np.column_stack([np.interp(t, seen["t"], seen[c]) for c in ("roll", "pitch")])
        assert walked.tilt is not None
        errors = TiltMisfit.of(MeasuredTilt(t, engine), t, walk.legs)
        away = errors.residuals(walked.tilt) * SD * np.sqrt(errors.strides)
        rms = np.degrees(np.sqrt((away.reshape(-1, 2) ** 2).mean(axis=0)))
        swing = np.degrees(errors.measured.std(axis=0))
        print(f"| {short(name)} | {rms[0]:.2f} {rms[1]:.2f}° | {swing[0]:.2f} {swing[1]:.2f}° |")
    yield from ()


def print_found(posterior: WalkPosterior, truth: str) -> None:
    """Say which legs the posterior takes for wrong."""
    print(f"\n{truth}:")
    for found in posterior.found()[:3]:
        degrees = (
            ""
            if found.case is None
            else f", {np.degrees(found.offset):.1f} ± {np.degrees(found.sd):.1f} deg"
        )
        print(f"  {found.name}: {found.probability:.0%}{degrees}")


def print_rows(scored: Sequence[Scored]) -> None:
    """Print a table, and what holds of all its rows."""
    if not scored:
        return
    print(
        "\n| predicted | informed by | turn | position, rms of path | 90 % band holds x, y, yaw | "
        "its half width x, y, yaw | CRPS x, y, yaw | best baseline's CRPS |"
    )
    print("|---|---|---:|---:|---:|---:|---:|---:|")
    for each in scored:
        print(row(each))
    held = sum(float((cover(each) * len(each.judged.track)).sum()) for each in scored)
    coordinates = sum(3 * len(each.judged.track) for each in scored)
    print(
        f"\n90 % bands hold {held / coordinates:.1%} of {coordinates} coordinates, "
        f"each tracked {len(scored[0].tracks)} times"
    )


def cover(scored: Scored) -> np.ndarray:
    """Return the share of poses within the 90 % band of x, y and yaw, of all tracks, shape (3,)."""
    scores = [judged.rows[0].scores for judged in scored.tracks]
    level = list(scores[0].levels).index(0.9)
    return np.mean([each.coverage[level] for each in scores], axis=0)


def row(scored: Scored) -> str:
    """Return a walk's row of the table, means over its tracks."""
    prediction = scored.judged.rows[0]
    error, unit = scored.turn_error
    turn = f"{100 * error:+.2f} % {unit}" if unit == "of radius" else f"{error:+.3f} {unit}"
    crps = np.mean([[each.scores.crps for each in run.rows] for run in scored.tracks], axis=0)
    of_path = np.mean([run.rows[0].errors.ate_of_length for run in scored.tracks])
    level = list(prediction.scores.levels).index(0.9)
    width = 0.5 * prediction.scores.width[level]
    held = " ".join(f"{share:.0%}" for share in cover(scored))
    return " | ".join([
        f"| {short(scored.walk.name)}", scored.informed_by, turn, f"{100 * of_path:.2f} %", held,
        f"{1000 * width[0]:.0f} {1000 * width[1]:.0f} mm {np.degrees(width[2]):.1f}°",
        _three(crps[0]), f"{_three(crps[1:].min(axis=0))} |",
    ])  # fmt: skip


def _three(values: Sequence[float] | np.ndarray) -> str:
    x, y, yaw = values
    return f"{1000 * x:.1f} {1000 * y:.1f} mm {np.degrees(yaw):.2f}°"


PARTS = {
    "half-circles": half_circles, "other-legs": other_legs, "floors": floors,
    "wrong-leg": wrong_leg, "wrong-leg-imu": partial(wrong_leg, imu=True), "straight": straight,
    "tilt": tilt, "fast-walk": fast_walk,
}  # fmt: skip


def main() -> None:
    """Print the tables asked for; all without a name."""
    given = [each for each in sys.argv[1:] if each != "--exact"]
    if not given:
        raise SystemExit(__doc__)
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(Path(given[0]), Path(scratch), counted="--exact" not in sys.argv)
        for asked in given[1:] or PARTS:
            name, _, number = asked.partition(":")
            print(f"\n## {asked}")
            print_rows(list(PARTS[name](bench, [int(number)]) if number else PARTS[name](bench)))


if __name__ == "__main__":
    main()
