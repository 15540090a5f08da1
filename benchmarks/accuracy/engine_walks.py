# SPDX-License-Identifier: MIT
"""Every walking model against walks of an independent rigid-body engine (simulated).

The walks are reference data (`ZEBRO_LAB_SHARED`, or the folder `shared` beside the checkout), each
driven by its own logged leg angles. Prints the table of `docs/theory.md`, 3.2, and what
`model.predict.ModelSpread` takes for our model's own errors.

Usage: python -m benchmarks.accuracy.engine_walks
"""

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from model.errors import DomainError
from model.gait.reference import SampledReference
from model.predict import FINE
from model.robot import GRAVITY, Robot
from model.thesis.traction import table_traction
from model.thesis.walk import ThesisOptions, walk_thesis
from model.walk.dynamics import DEFAULT_OPTIONS, DynamicsOptions, walk
from model.walk.no_slip import walk_no_slip, walk_wheels
from model.walk.path import WalkPath, turning_radius
from model.walk.traction import VelocityCoulomb

STRAIGHT = 5.0  # a radius beyond this is a straight line's [m]
EVERY = 0.1  # s between poses compared
SHARED = Path(os.environ.get("ZEBRO_LAB_SHARED", Path(__file__).parents[3] / "shared"))


@dataclass(frozen=True)
class EngineWalk:
    """A walk of the engine: who walked, how, and where it led.

    Attributes:
        name: Its file's name.
        robot: The robot.
        log: Its leg angles.
        friction: Friction coefficient [-].
        left: Whether it turns left.
        period: Cycle time [s].
        truth: t, x, y and yaw, and what else the engine recorded.
    """

    name: str
    robot: Robot
    log: SampledReference
    friction: float
    left: bool
    period: float
    truth: pd.DataFrame

    @property
    def duration(self) -> float:
        """Time walked [s]."""
        return float(self.truth["t"].iloc[-1])


def read_walk(file: Path) -> EngineWalk:
    """Read a walk from its JSON file and the table beside it."""
    about = json.loads(file.read_text())
    truth = pd.read_csv(file.with_suffix(".csv.gz"))
    theta = truth[[f"th{i}" for i in range(1, 7)]].to_numpy()
    return EngineWalk(
        name=file.stem,
        robot=Robot(leg_arc=np.radians(about["params"]["arc"])),
        log=SampledReference(truth["t"].to_numpy(), theta),
        friction=about["params"]["mu"],
        left=about["gait"]["turn"] == "left",
        period=about["gait"]["period_s"],
        truth=truth,
    )


def by_dynamics(one: EngineWalk, options: DynamicsOptions = DEFAULT_OPTIONS) -> WalkPath:
    """Walk by our model, Coulomb friction over 1 mm/s as in the engine."""
    table = VelocityCoulomb(one.friction).table(weight=one.robot.mass * GRAVITY)
    return walk(one.robot, one.log, table, duration=one.duration, options=options)


def by_thesis(one: EngineWalk) -> WalkPath:
    """Walk by the thesis's model with the same friction."""
    table = VelocityCoulomb(one.friction).table(weight=one.robot.mass * GRAVITY)
    options = ThesisOptions(direction="left" if one.left else "right")
    return walk_thesis(
        one.robot, one.log, duration=one.duration, traction=table_traction(table), options=options
    )


MODELS: dict[str, Callable[[EngineWalk], WalkPath]] = {
    "dynamics": by_dynamics,
    "thesis": by_thesis,
    "no-slip": lambda one: walk_no_slip(one.robot, one.log, duration=one.duration),
    "no-slip-simple": lambda one: walk_wheels(one.robot, one.log, duration=one.duration),
}


def path_error(path: WalkPath, truth: pd.DataFrame) -> float:
    """Compute the rms distance from the truth over its length [-]."""
    x, y = (np.interp(truth["t"], path.t, path.position[:, i]) for i in range(2))
    length = np.hypot(np.diff(truth["x"]), np.diff(truth["y"])).sum()
    return float(np.sqrt(np.mean((x - truth["x"]) ** 2 + (y - truth["y"]) ** 2)) / length)


def radius(t: np.ndarray, xy: np.ndarray, yaw: np.ndarray, period: float) -> float:
    """Compute the turning radius over whole strides, the first and last left out [m]."""
    ends = period * np.array([1, int(t[-1] // period) - 1])
    at = np.searchsorted(t, ends - 1e-6)
    return turning_radius(xy[at], yaw[at])


def bend(one: EngineWalk, path: WalkPath) -> tuple[float, float]:
    """Compute by how much our path is to be stretched [-] and bent [rad/m] to be the engine's."""
    t = np.arange(0.0, one.duration - EVERY, EVERY)
    ours = np.column_stack([np.interp(t, path.t, a) for a in path.position[:, :2].T])
    theirs = np.column_stack([np.interp(t, one.truth["t"], one.truth[c]) for c in ("x", "y")])
    walked = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ours, axis=0), axis=1))])
    length = np.linalg.norm(np.diff(theirs, axis=0), axis=1).sum()
    turned = np.interp(t, one.truth["t"], one.truth["yaw"]) - np.interp(t, path.t, path.yaw)
    return length / walked[-1] - 1, float((turned - turned[0]) @ walked / (walked @ walked))


def by_contacts(one: EngineWalk) -> np.ndarray:
    """Compute how contacts twice as hard or damped, and half, stretch and bend our path."""
    stiffness, damping = FINE.stiffness, FINE.damping
    pairs = [
        [replace(FINE, stiffness=stiffness * each) for each in (2.0, 0.5)],
        [replace(FINE, damping=damping * each) for each in (2.0, 0.5)],
    ]
    ends = np.array([[bend(one, by_dynamics(one, each)) for each in pair] for pair in pairs])
    moved = 0.5 * (ends[:, 0] - ends[:, 1])
    return np.sqrt((moved**2).sum(axis=0))


def print_bends(walks: Sequence[EngineWalk]) -> None:
    """Print what each walk, and those of matched heights together, say of the model's errors."""
    bends = [bend(one, by_dynamics(one, FINE)) for one in walks]
    matched = [bends[i] for i, one in enumerate(walks) if heights_match(one)]
    print(f"\ndynamics by steps of {1e3 * FINE.dt:g} ms, to be stretched and bent:\n")
    print("| walk | distance | curvature | by contacts | |\n|---|---:|---:|---:|---:|")
    for one, (distance, curvature) in zip(walks, bends, strict=True):
        longer, rounder = by_contacts(one)
        print(
            f"| {one.name} | {100 * distance:+.2f} % | {curvature:+.4f} rad/m | "
            f"{100 * longer:.2f} % | {rounder:.4f} rad/m |"
        )
    print()
    for of, some in (("all", bends), ("tripods that lift off at matched heights", matched)):
        distance, curvature = np.sqrt((np.array(some) ** 2).mean(axis=0))
        print(f"root mean square of {of}: {100 * distance:.2f} %, {curvature:.4f} rad/m")


def heights_match(one: EngineWalk) -> bool:
    """Tell whether three legs carry at a time and the next three take over at their height."""
    return one.name.startswith("tripod") and not one.name.endswith("real")


def figures(one: EngineWalk, model: Callable[[EngineWalk], WalkPath]) -> str:
    """Say the path's error and the radius's; the thesis's model walks tripods only."""
    try:
        path = model(one)
    except DomainError:
        if model is not by_thesis:
            raise
        return "not a tripod"
    error = f"{100 * path_error(path, one.truth):.2f} %"
    t, yaw, xy = (one.truth[c].to_numpy() for c in ("t", "yaw", ["x", "y"]))
    theirs = radius(t, xy, yaw, one.period)
    if abs(theirs) > STRAIGHT:
        return error
    ours = radius(path.t, path.position[:, :2], path.yaw, one.period)
    return f"{error} ({100 * (ours / theirs - 1):+.2f} %)"


def main() -> None:
    """Print the table."""
    files = sorted((SHARED / "virtual-world" / "walks").glob("*.json"))
    if not files:
        raise SystemExit(f"no walks under {SHARED}; set ZEBRO_LAB_SHARED to the reference data")
    print("Path error, rms over length (radius error), driven by the engine's leg angles:\n")
    print(f"| walk | {' | '.join(MODELS)} |\n|---|{'---:|' * len(MODELS)}")
    for file in files:
        one = read_walk(file)
        print(f"| {one.name} | {' | '.join(figures(one, m) for m in MODELS.values())} |")
    hard = DynamicsOptions(stiffness=10 * DEFAULT_OPTIONS.stiffness)
    print("\ndynamics, contacts ten times as stiff, where four legs carry:\n")
    for file in files:
        if file.stem.startswith("tetrapod"):
            one = read_walk(file)
            print(f"| {one.name} | {figures(one, lambda w: by_dynamics(w, hard))} |")
    print_bends([read_walk(file) for file in files])


if __name__ == "__main__":
    main()
