# SPDX-License-Identifier: MIT
"""Make the simulated rig sweep in this folder: `python datasets/rig-sim/generate.py`.

Everything follows from `SEED`: the load cell's errors are drawn first, the sweep after. The order
of the slip ratios, the same at each load, is drawn apart from them.
"""

import gzip
import hashlib
import os
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd

from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import RigImperfections, draw_imperfections, with_load_noise
from rig.slip_rig.sweep import SweepPlan

sys.path.append(str(Path(__file__).parents[2] / "tests"))
from support.simulated_sweep import SimulatedSweep, simulate_sweep

SEED = 2020
HALF = np.array(
    [0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.065, 0.08, 0.1, 0.14, 0.2, 0.3, 0.5, 0.9]
)
SLIPS = np.tile(np.concatenate([-HALF[::-1], [0.0], HALF]), 2)  # both signs, each twice
PLAN = SweepPlan(slips=tuple(np.random.default_rng([SEED, 1]).permutation(SLIPS).tolist()))
SOURCE = "sim:rig-sweep"

TYPES = {  # float32 rounds at 1e-6 of what a sensor's noise already blurs; time has no noise
    "t": np.float64,
    "omega_leg": np.float32,
    "omega_ground": np.float32,
    "normal_force": np.float32,
    "traction_force": np.float32,
    "run": np.int16,
}


def simulate() -> tuple[SimulatedSweep, RigImperfections]:
    """Draw the rig's errors and simulate its sweep.

    Returns:
        The sweep and the errors it was made with.
    """
    rng = np.random.default_rng(SEED)
    imperfections = with_load_noise(draw_imperfections(rng))
    sweep = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=PLAN, imperfections=imperfections, rng=rng
    )
    return sweep, imperfections


def tables(sweep: SimulatedSweep) -> dict[str, pd.DataFrame]:
    """Cut the log into one table a load, by file name."""
    rounded = {name: sweep.table[name].astype(kind) for name, kind in TYPES.items()}
    whole = pd.DataFrame(
        {name: x if name == "run" else x.astype(float) for name, x in rounded.items()}
    )
    rows = len(PLAN.slips) * PLAN.n_samples
    return {
        f"simulated_load_{load:05.2f}N.csv.gz": whole[rows * position : rows * (position + 1)]
        for position, load in enumerate(PLAN.loads)
    }


def truth(imperfections: RigImperfections) -> str:
    """Write the true values as TOML: those of the law, and those of the rig."""
    law = {p.name: v for p, v in zip(THESIS_LAW.parameters, THESIS_VALUES, strict=True)}
    lines = ["# The true values behind this simulated sweep; written by generate.py."]
    lines += [f'source = "{SOURCE}"', f"seed = {SEED}"]
    lines += ["", f"[{THESIS_LAW.name}]", *(f"{name} = {value!r}" for name, value in law.items())]
    errors = asdict(imperfections)
    lines += ["", "[rig]", *(f"{name} = {value!r}" for name, value in errors.items())]
    return "\n".join(lines) + "\n"


def manifest(folder: Path) -> str:
    """Write the SHA-256 of every file of the folder, but for the manifest itself, as TOML."""
    files = sorted(p for p in folder.glob("[!.]*") if p.is_file() and p.name != "manifest.toml")
    hashes = (f'"{p.name}" = "{hashlib.sha256(p.read_bytes()).hexdigest()}"' for p in files)
    return "\n".join(["[files]", *hashes]) + "\n"


def write(folder: Path) -> None:
    """Write every generated file into a folder; each replaces its forerunner whole.

    Args:
        folder: Existing folder.
    """
    sweep, imperfections = simulate()
    for name, table in tables(sweep).items():
        text = table.to_csv(index=False, lineterminator="\n")
        _replace(folder / name, gzip.compress(text.encode(), mtime=0))
    _replace(folder / "truth.toml", truth(imperfections).encode())
    _replace(folder / "manifest.toml", manifest(folder).encode())


def _replace(path: Path, content: bytes) -> None:
    """Write a file so that a reader, or an interruption, never meets half of it."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=".")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        Path(temporary).chmod(0o644)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


if __name__ == "__main__":
    here = Path(__file__).parent
    write(here)
    for made in sorted(here.iterdir()):
        print(f"{made.stat().st_size:>9,} B  {made.name}")
