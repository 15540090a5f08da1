# SPDX-License-Identifier: MIT
"""A first experiment of 2 loads x 12 slips on a simulated rig, its verdict, then what it advises.

python -m benchmarks.accuracy.first_experiment [SEEDS] [FIRST] [TRUTH] [SLIPS]

By commands alone and with default options: `rig run` and `calibrate-slip`; then the lines of a plan
that the advice holds, put into a copy of the plan, run into another folder, and both folders fitted
together. Each seed, from FIRST on, is a rig of its own, load cell and all. TRUTH is the rig's slip
curve: `thesis` or `steep`, which no command simulates, so that the plan is run by the command's own
function. SLIPS of the first plan are `even` over 0 to 1, or `rise`, crowded where the curve rises.
Prints whether the 90 % intervals of slip stiffness and friction hold the truth and what the verdict
says, before and after.
"""

import sys
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

import tomlkit

from benchmarks.accuracy.calibrated_experiments import BIN, NAMES, run
from model.slip.law import Values
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.experiment.control import Control
from rig.experiment.watcher import ExperimentWatcher
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.experiment.stage import run_experiment

PLAN = """
schema = 1
name = "first experiment"
material = "leg on ground"
[points]
loads = [5.0, 10.0]
slips = SLIPS
omega_leg = 12.0
length = "duration"
duration = 1.0
order = "monotone"
[load]
set_by = "hand"
tolerance = 0.3
[settle]
window = 0.2
speed = 0.3
friction = 0.15
timeout = 3.0
[accept]
slip = 0.02
slip_drift = 0.02
friction_drift = 0.2
[controls]
[limits]
speed = 40.0
acceleration = 40.0
normal_force = 25.0
traction_force = 15.0
speed_error = 4.0
"""
JUDGED = ("slip_stiffness", "friction")
SLIPS = {
    "even": "{ first = 0.0, last = 1.0, count = 12 }",
    "rise": "[0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.06, 0.1, 0.2, 0.35, 0.6, 0.9]",
}
TRUTHS = {
    "thesis": THESIS_VALUES,
    "steep": (2 * THESIS_VALUES[0], THESIS_VALUES[1], 0.6, THESIS_VALUES[3]),
}
"""True values of the law, in the order of `NAMES`; the steep curve also has the higher friction."""


@dataclass(frozen=True)
class Found:
    """What one calibration says.

    Attributes:
        covered: Whether the 90 % interval holds the truth, for each of `JUDGED`.
        trustworthy: Whether the verdict says so.
        headline: The verdict's headline.
        steps: What the verdict advises.
    """

    covered: tuple[bool, ...]
    trustworthy: bool
    headline: str
    steps: tuple[str, ...]

    def cells(self) -> str:
        """Format the result as cells of a row."""
        held = ("yes" if covered else "NO" for covered in self.covered)
        return " | ".join((*held, self.headline))


def read_found(folder: Path, truth: Values) -> Found:
    """Read verdict of a calibration folder, and whether its intervals hold the truth."""
    true = dict(zip(NAMES, truth, strict=True))
    content = tomllib.loads((folder / "slip.toml").read_text(encoding="utf-8"))
    ends = [(content["parameters"][name]["q05"], content["parameters"][name]["q95"])
            for name in JUDGED]  # fmt: skip
    verdict = content["verdict"]
    return Found(
        covered=tuple(low < true[n] < high for n, (low, high) in zip(JUDGED, ends, strict=True)),
        trustworthy=verdict["trustworthy"],
        headline=verdict["headline"],
        steps=tuple(verdict["next_steps"]),
    )


def advised_plan(plan: str, steps: tuple[str, ...]) -> str | None:
    """Set in a plan what the lines of a plan in the advice say; None where it holds no such lines.

    Args:
        plan: Text of the plan.
        steps: What the verdict advises; the lines from the first table's head to the last value.
    """
    for step in steps:
        lines = step.splitlines()
        heads = [i for i, line in enumerate(lines) if line.startswith("[")]
        if heads:
            ends = [i for i, line in enumerate(lines) if " = " in line]
            changed = tomlkit.parse(plan)
            for name, keys in tomllib.loads("\n".join(lines[heads[0] : ends[-1] + 1])).items():
                changed[name].update(keys)  # pyright: ignore[reportAttributeAccessIssue]
            return tomlkit.dumps(changed)
    return None


def measure(plan: str, seed: int, data: Path, truth: Values) -> None:
    """Run a plan on the simulated rig of a seed into a folder."""
    file = data.with_suffix(".toml")
    file.write_text(plan, encoding="utf-8")
    if truth is THESIS_VALUES:
        run(BIN / "zebro-lab", "rig", "run", file, "--rig", "sim", "--fast", "--seed", seed,
            "--data", data)  # fmt: skip
        return
    request = RigRunRequest(file, "sim", data, fast=True, seed=seed)
    run_experiment(request, ExperimentWatcher(), Control(), law=(THESIS_LAW, truth))


def follow(seed: int, folder: Path, plan: str, truth: Values) -> tuple[Found, Found | None]:
    """Return what the first experiment says, and what it says after its advice, if that has any."""
    data, further = folder / "data", folder / "further"
    measure(plan, seed, data, truth)
    run(BIN / "calibrate-slip", data, "--out", folder / "first")
    first = read_found(folder / "first", truth)
    advised = advised_plan(plan, first.steps)
    if advised is None:
        return first, None
    measure(advised, seed, further, truth)
    run(BIN / "calibrate-slip", data, further, "--out", folder / "after")
    return first, read_found(folder / "after", truth)


def main(seeds: int, first_seed: int, truth: Values, slips: str) -> None:
    """Print the table, then how many of each kind there are."""
    print("| seed | K held | mu held | first verdict | K held, after | mu held, after | verdict |")
    print("|---|---|---|---|---|---|---|")
    plan = PLAN.replace("SLIPS", slips)
    before, after = [], []
    for seed in range(first_seed, first_seed + seeds):
        with tempfile.TemporaryDirectory() as folder:
            first, then = follow(seed, Path(folder), plan, truth)
        before.append(first)
        after.append(then or first)
        cells = "| | no plan was advised" if then is None else then.cells()
        print(f"| {seed} | {first.cells()} | {cells} |", flush=True)
    for name, found in (("first experiment", before), ("after its advice", after)):
        print(f"\n{name}, of {seeds}: " + ", ".join(
            f"{what} {sum(map(each, found))}" for what, each in COUNTS.items()))  # fmt: skip


COUNTS = {
    "K held": lambda found: found.covered[0],
    "mu held": lambda found: found.covered[1],
    "trustworthy": lambda found: found.trustworthy,
    "trustworthy and both held": lambda found: found.trustworthy and all(found.covered),
    "trustworthy though not both held": lambda found: found.trustworthy and not all(found.covered),
}

if __name__ == "__main__":
    given = dict(enumerate(sys.argv[1:]))
    main(
        int(given.get(0, 20)), int(given.get(1, 0)), TRUTHS[given.get(2, "thesis")],
        SLIPS[given.get(3, "even")],
    )  # fmt: skip
