# SPDX-License-Identifier: MIT
"""Why the thesis's circles are too tight, what a leg angle is worth, and a left turn to the right.

Prints the tables of `docs/theory.md`, chapter 3, and draws its figures. Everything is simulated.

Usage: python -m benchmarks.accuracy.turning_radius
"""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import numpy as np

from model.gait.steering import TripodAngles, tripod_angles, tripod_reference
from model.gait.suriana import suriana_reference
from model.robot import Robot
from model.slip import MagicFormula
from model.thesis.walk import walk_thesis
from model.walk.dynamics import walk
from model.walk.no_slip import walk_no_slip, walk_wheels
from model.walk.path import WalkPath, turning_radius
from model.walk.traction import TractionTable, law_table

mpl.use("Agg")
import matplotlib.pyplot as plt

IMAGES = Path(__file__).parents[2] / "docs" / "images"
CYCLE = 2.0  # s
INNER = 50.0  # touchdown angle of the inner legs [deg]
FACTORS = (1.05, 1.1, 1.15, 1.2, 1.3, 1.4, 1.5)
MEASURED = {  # degrees: inner lift-off, outer touchdown and lift-off, Tables 5-3 to 5-5
    1.1: (130.0, 46.0, 132.0),
    1.3: (130.0, 37.8, 138.0),
    1.5: (130.0, 29.7, 143.0),
}
SOURCE = np.array([34.34 * 1.564 * 0.3798, 1.564, 0.3798, 0.0066])
HALF, LONG = Robot(), Robot(leg_arc=np.radians(200.0))


@cache
def slip_table(mu: float = 0.3798) -> TractionTable:
    """Tabulate the thesis's law, its friction replaced and its shape kept."""
    values = SOURCE * [mu / 0.3798, 1.0, mu / 0.3798, 1.0]
    return law_table(MagicFormula("peak"), values, weight=HALF.mass * 9.81)


def measured_angles(factor: float) -> TripodAngles:
    """Return the angles the thesis found on its robot."""
    up, outer_down, outer_up = MEASURED[factor]
    return TripodAngles(*np.radians([INNER, up, outer_down, outer_up]))


def ideal_angles(factor: float, robot: Robot = HALF) -> TripodAngles:
    """Return angles with matched hip heights."""
    return tripod_angles(np.radians(INNER), factor, leg_arc=robot.leg_arc)


def radius(path: WalkPath, *, period: float = CYCLE) -> float:
    """Compute the turning radius over the whole strides behind the first [m]."""
    strides = int(path.t[-1] / period + 1e-9)
    ends = np.searchsorted(path.t, period * np.array([1, strides]) - 1e-6)
    return turning_radius(path.position[ends, :2], path.yaw[ends])


def turn(angles: TripodAngles, robot: Robot, *, mu: float = 0.3798) -> float:
    """Compute the radius of our model [m]."""
    gait = tripod_reference(angles, CYCLE)
    return radius(walk(robot, gait, slip_table(mu), duration=5 * CYCLE))


def no_slip_turn(angles: TripodAngles, robot: Robot) -> float:
    """Compute the radius of exact leg kinematics [m]."""
    return radius(walk_no_slip(robot, tripod_reference(angles, CYCLE), duration=5 * CYCLE))


def table(title: str, columns: list[str], rows: list[list[str]]) -> None:
    """Print a table in Markdown."""
    print(f"\n### {title}\n")
    print(f"| {' | '.join(columns)} |\n|{'---:|' * len(columns)}")
    for row in rows:
        print(f"| {' | '.join(row)} |")


def radius_against_steering() -> None:
    """Print and draw the turning radius of every model over the steering factor."""
    wheels, kinematic, source, ours, found = [], [], [], [], {}
    for factor in FACTORS:
        angles = ideal_angles(factor)
        gait = tripod_reference(angles, CYCLE)
        wheels.append(radius(walk_wheels(HALF, gait, duration=5 * CYCLE)))
        kinematic.append(no_slip_turn(angles, HALF))
        source.append(radius(walk_thesis(HALF, gait, duration=5 * CYCLE)))
        ours.append(turn(angles, HALF))
        if factor in MEASURED:
            found[factor] = turn(measured_angles(factor), LONG)
    table(
        "Turning radius [m] against steering factor",
        ["s", "wheels 2rθ̇", "no slip", "thesis's model", "ours, its angles",
         "ours, measured angles, 200° legs"],
        [
            [f"{s:g}", *(f"{x:.3f}" for x in row), f"{found[s]:.3f}" if s in found else ""]
            for s, *row in zip(FACTORS, wheels, kinematic, source, ours, strict=True)
        ],
    )  # fmt: skip
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    axes.plot(FACTORS, wheels, ":", color="0.6", label="wheels, 2rθ̇ (the predecessor's)")
    axes.plot(FACTORS, kinematic, "--", color="0.4", label="no slip, exact leg kinematics")
    axes.plot(FACTORS, source, "s-", ms=4, color="C1", label="the thesis's model")
    axes.plot(FACTORS, ours, "o-", ms=4, color="C0", label="ours, the thesis's angles")
    axes.plot(list(found), list(found.values()), "D-", ms=5, color="C3",
              label="ours, angles measured on the robot, 200° legs")  # fmt: skip
    axes.set(
        xlabel="steering factor s [-]", ylabel="turning radius [m]", yscale="log",
        title="Turning radius of a left turn, inner touchdown 50° (simulated)",
    )  # fmt: skip
    axes.set_yticks([0.5, 1, 2, 5], ["0.5", "1", "2", "5"])
    axes.set_yticks([], minor=True)
    axes.grid(alpha=0.3, which="both")
    axes.legend(frameon=False)
    figure.savefig(IMAGES / "turning-radius.png", dpi=130)


def contributions() -> None:
    """Print what each effect does to the radius, one after the other."""
    rows = []
    for factor in MEASURED:
        ideal, longer = ideal_angles(factor), ideal_angles(factor, LONG)
        real = measured_angles(factor)
        steps = [
            no_slip_turn(ideal, HALF), turn(ideal, HALF), turn(longer, LONG), turn(real, LONG),
        ]  # fmt: skip
        changes = [f"{100 * (b / a - 1):+.1f} %" for a, b in pairwise(steps)]
        rows.append(
            [f"{factor:g}", f"{real.steering_factor:.3f}", f"{steps[0]:.3f}", *changes,
             f"{steps[-1]:.3f}"]
        )  # fmt: skip
    table(
        "What widens the turn",
        ["s", "s of the measured angles", "no slip [m]", "combined slip", "200° legs, matched",
         "measured angles", "all [m]"],
        rows,
    )  # fmt: skip


def grip() -> None:
    """Print what friction changes."""
    rows = [
        [
            f"{mu:g}",
            f"{turn(ideal_angles(1.3), HALF, mu=mu):.4f}",
            f"{turn(measured_angles(1.3), LONG, mu=mu):.4f}",
        ]
        for mu in (0.2, 0.38, 0.7)
    ]
    table("Radius [m] against friction, s = 1.3",
          ["μ", "matched heights", "measured angles, 200° legs"], rows)  # fmt: skip


OFFSETS = (-5.0, -1.8, -0.5, 0.0, 0.5, 1.8, 5.0)  # degrees


def leg_offsets() -> None:
    """Print and draw the curvature of a turn with one leg off its angle."""
    gait = tripod_reference(ideal_angles(1.1), CYCLE)
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    rows = []
    for leg in range(6):
        radii = []
        for offset in OFFSETS:
            offsets = np.zeros(6)
            offsets[leg] = np.radians(offset)
            robot = replace(HALF, leg_offset=offsets)
            radii.append(radius(walk(robot, gait, slip_table(), duration=5 * CYCLE)))
        rows.append([str(leg + 1), *(f"{r:.2f}" for r in radii)])
        axes.plot(OFFSETS, 1 / np.array(radii), "o-", ms=4, label=f"leg {leg + 1}")
    table("Radius [m] with one leg off its angle, s = 1.1, left",
          ["leg", *(f"{o:+g}°" for o in OFFSETS)], rows)  # fmt: skip
    axes.axhline(0, color="0.5", lw=0.8)
    axes.set(
        xlabel="offset of one leg [deg]", ylabel="curvature of the path [1/m], left positive",
        title="What one leg's angle is worth, s = 1.1, a left turn (simulated)",
    )  # fmt: skip
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, ncols=2)
    figure.savefig(IMAGES / "leg-offsets.png", dpi=130)


def the_left_turn_that_went_right() -> None:
    """Print the predecessor's turns with and without its middle left leg 5 degrees behind."""
    offsets = np.zeros(6)
    offsets[2] = np.radians(-5.0)
    rows = []
    for tau_turn in (0.05, 0.1, 0.2):
        period = 1.6 + tau_turn
        row = [f"{tau_turn:g}"]
        for direction in ("left", "right"):
            gait = suriana_reference(
                np.radians(35.0), np.radians(130.0), ground_time=0.8, flight_time=0.8,
                turn_time=tau_turn, direction=direction,
            )  # fmt: skip
            for robot in (LONG, replace(LONG, leg_offset=offsets)):
                path = walk(robot, gait, slip_table(), duration=8 * period)
                row.append(f"{np.degrees(path.yaw[-1]) / (8 * period):+.2f}")
        rows.append(row)
    table(
        "Yaw rate [deg/s], left positive, of the predecessor's gait",
        ["τ_p [s]", "left", "left, leg 3 at −5°", "right", "right, leg 3 at −5°"],
        rows,
    )


def main() -> None:
    """Print every table and draw every figure."""
    radius_against_steering()
    contributions()
    grip()
    leg_offsets()
    the_left_turn_that_went_right()


if __name__ == "__main__":
    main()
