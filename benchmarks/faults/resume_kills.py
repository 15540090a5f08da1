# SPDX-License-Identifier: MIT
"""Kill a fast simulated experiment at random instants, resume it, and count its points.

    python -m benchmarks.faults.resume_kills [TRIALS] [SEED]

Half of the kills come at a random time of the run, the others between the end record of a run
folder and its line in the journal. Each experiment runs in a process of its own, ended by SIGKILL,
and is resumed by another one. Printed are how often a point was counted other than once, a refused
attempt was counted, or an accepted point lacked samples. All of it is simulated.
"""

import os
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from rig.experiment.control import Control
from rig.experiment.sink import ExperimentWatcher
from zebro_lab.experiment.journal import JournalWriter
from zebro_lab.experiment.request import RigRunRequest
from zebro_lab.experiment.stage import run_experiment
from zebro_lab.runs.folder import find_runs, read_slip_rig_run
from zebro_lab.runs.manifest import read_manifest

PLAN: Final = """
schema = 1
name = "killed"
material = "simulated"
[points]
loads = [4.0, 8.0]
slips = [0.1, 0.6]
omega_leg = 12.0
length = "duration"
duration = 0.3
order = "monotone"
[load]
set_by = "hand"
tolerance = 8.0
[settle]
window = 0.2
speed = 0.3
friction = 0.4
timeout = 3.0
[accept]
slip = 0.0015    # so narrow that some attempts are refused
slip_drift = 0.05
friction_drift = 0.5
attempts = 40
[controls]
tare_duration = 0.3
[limits]
speed = 40.0
acceleration = 40.0
normal_force = 25.0
traction_force = 15.0
speed_error = 4.0
"""
POINTS: Final = 4
LEAST_SAMPLES: Final = 0.95 * 0.3 * 1000
"""Of a point of 0.3 s from a board that sends 1,000 samples a second, its ends left out."""


@dataclass
class Tally:
    """What was found.

    Attributes:
        trials: Experiments that were killed and resumed.
        refused: Attempts that were refused in them, all told.
        faults: What was wrong, and how often.
    """

    trials: int = 0
    refused: int = 0
    faults: Counter[str] = field(default_factory=Counter)


def in_a_process(work: Callable[[], object]) -> int:
    """Start a process that does some work; return its number."""
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        work()
        code = 0
    finally:
        os._exit(code)


def run(plan: Path, data: Path, seed: int, *, resume: bool = False) -> object:
    """Run the plan on a twin whose time passes at once."""
    request = RigRunRequest(plan, "sim", data, resume=resume, fast=True, seed=seed)
    return run_experiment(request, ExperimentWatcher(), Control())


def die_before_line(number: int) -> None:
    """Let this process be killed when it is about to write a point's line in the journal."""
    append, left = JournalWriter.append, [number]

    def killed(self: JournalWriter, kind: str, text: str, **more: object) -> None:
        left[0] -= kind == "point"
        if kind == "point" and left[0] == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        append(self, kind, text, **more)

    JournalWriter.append = killed


def killed_run(
    plan: Path, data: Path, rng: np.random.Generator, lasts: float, *, at_line: bool
) -> None:
    """Run the plan in a process, and kill it: at a line of the journal, or at a random time."""
    seed = int(rng.integers(1000))
    if at_line:
        line = int(rng.integers(1, POINTS + 1))

        def work() -> None:
            die_before_line(line)
            run(plan, data, seed)

        os.waitpid(in_a_process(work), 0)
        return
    child = in_a_process(lambda: run(plan, data, seed))
    time.sleep(rng.uniform(0.0, lasts))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


def judge(data: Path, tally: Tally) -> None:
    """Count the runs of an experiment that are taken, by their point."""
    taken: Counter[int] = Counter()
    for folder in find_runs(data):
        manifest = read_manifest(folder)
        accepted = manifest.point.get("accepted") is True
        tally.refused += manifest.exit_status == "completed" and not accepted
        if manifest.excluded is not None:
            continue
        taken[manifest.point.get("number", 0)] += 1
        if not accepted:
            tally.faults["a refused attempt is counted"] += 1
        elif len(read_slip_rig_run(folder).table) < LEAST_SAMPLES:
            tally.faults["an accepted point lacks samples"] += 1
    if sorted(taken.values()) != [1] * POINTS:
        tally.faults[f"points are counted {sorted(taken.values())} times"] += 1


def trial(rng: np.random.Generator, lasts: float, tally: Tally) -> None:
    """Kill one experiment, resume it and judge it."""
    with tempfile.TemporaryDirectory() as place:
        plan, data = Path(place) / "plan.toml", Path(place) / "data"
        plan.write_text(PLAN)
        killed_run(plan, data, rng, lasts, at_line=tally.trials % 2 == 1)
        begun = (data / "experiment.jsonl").exists()
        _, status = os.waitpid(in_a_process(lambda: run(plan, data, 7, resume=begun)), 0)
        tally.trials += 1
        if status:
            tally.faults["it could not be resumed"] += 1
        else:
            judge(data, tally)


def main(trials: int, seed: int) -> int:
    """Print what was found; return 1 where anything was wrong."""
    rng, tally = np.random.default_rng(seed), Tally()
    with tempfile.TemporaryDirectory() as place:
        plan = Path(place) / "plan.toml"
        plan.write_text(PLAN)
        began = time.monotonic()
        os.waitpid(in_a_process(lambda: run(plan, Path(place) / "data", 1)), 0)
        lasts = time.monotonic() - began
    for _ in range(trials):
        trial(rng, lasts, tally)
    print(f"seed {seed}: {tally.trials} experiments killed and resumed, a whole one takes "
          f"{lasts:.1f} s; {tally.refused} attempts were refused")  # fmt: skip
    faults = [f"{count} x {what}" for what, count in tally.faults.items()]
    well = "every point was counted once, no refused attempt was, no sample is missing"
    print("\n".join(faults or [well]))
    return 1 if tally.faults else 0


if __name__ == "__main__":
    given = [int(text) for text in sys.argv[1:]]
    raise SystemExit(main(*(given + [200, 1][len(given) :])))
