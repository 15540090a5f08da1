# SPDX-License-Identifier: MIT
"""Options of the commands of a checkout, and the modules of it that run for a command."""

import json
import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.code_structure.measures import Checkout, Measured

PROBE = Path(__file__).with_name("probe.py")
COUNTED_ALONE = ("calibrate", "walk", "predict", "track")
RIG, WALK = "datasets/rig-sim", "datasets/walk-sim"


def probe(root: Path, *arguments: str) -> str:
    """Run the probe with a checkout on the import path; return the last line that it printed.

    Raises:
        SystemExit: It failed; the end of what it printed is in the message.
    """
    environment = os.environ | {"PYTHONPATH": str(root), "OPENBLAS_NUM_THREADS": "1"}
    ended = subprocess.run(
        [sys.executable, "-P", str(PROBE), *arguments],
        cwd=root, env=environment, capture_output=True, text=True,
    )  # fmt: skip
    if ended.returncode:
        raise SystemExit(f"{' '.join(arguments)} failed in {root}: {ended.stderr[-2000:]}")
    return ended.stdout.splitlines()[-1]


def options_of(root: Path) -> dict[str, list[str]]:
    """Return the options of every command, without those that all commands have."""
    return json.loads(probe(root.resolve(), "options"))


def option_measures(checkout: Checkout) -> dict[str, Measured]:
    """Count the options of all commands together, and of the largest ones alone."""
    found = options_of(checkout.root)
    every = tuple(f"{len(names)} {command}: {' '.join(names)}" for command, names in found.items())
    total = Measured(str(sum(map(len, found.values()))), every)
    alone = {
        f"options of {command}": Measured(str(len(found[command])), tuple(found[command]))
        for command in COUNTED_ALONE
    }
    return {"options of all commands": total} | alone


def module_measures(checkout: Checkout) -> dict[str, Measured]:
    """Count the modules that run for the three main commands, on the bundled (simulated) data."""
    root = checkout.root.resolve()
    with TemporaryDirectory() as folder:
        fit, path, track = (str(Path(folder) / name) for name in ("fit", "path", "track"))
        one = ["--workers", "1"] if "--workers" in options_of(root)["track"] else []
        robot = ["--robot", f"{WALK}/robot.toml"]
        lines = {
            "calibrate-slip": ["calibrate", RIG, "--out", fit],
            "predict": ["predict", f"{WALK}/legs.csv", "--slip", fit, "--draws", "20",
                        "--figures", "--out", path, *robot],
            "track": ["track", f"{WALK}/photos", "--camera", f"{WALK}/camera.toml", "--floor",
                      f"{WALK}/floor.toml", "--start", "2020-06-01T12:00:00+00:00",
                      "--out", track, *robot, *one],
        }  # fmt: skip
        ran = {name: json.loads(probe(root, "modules", *line)) for name, line in lines.items()}
    return {
        f"modules that run for {name}": Measured(str(len(files)), tuple(files))
        for name, files in ran.items()
    }
