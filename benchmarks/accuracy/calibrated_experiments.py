# SPDX-License-Identifier: MIT
"""The thesis's whole plan on a simulated rig, then `calibrate-slip`, as commands, for many seeds.

python -m benchmarks.accuracy.calibrated_experiments [SEEDS]

Each seed is a rig of its own, load cell and all. Prints how far each fit is from the truth, in
posterior standard deviations, the chi-square of each and of all, and how long it took.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy.stats import chi2

from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import GAIN_SD
from zebro_lab.calibration.folder import read_slip

PLAN = Path(__file__).parents[2] / "examples" / "plan-thesis.toml"
BIN = Path(sys.executable).parent
NAMES = [parameter.name for parameter in THESIS_LAW.parameters]


def run(*command: object) -> int:
    """Run a command; 3 (points refused, not converged) is an answer, other failures are not."""
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False
    )
    if done.returncode not in (0, 3):
        raise RuntimeError(done.stderr)
    return done.returncode


def calibrate(seed: int, folder: Path) -> tuple[np.ndarray, np.ndarray, str]:
    """Measure and fit one rig; return the misses over sd, the relative sds and exit codes."""
    data, out = folder / "data", folder / "calibration"
    measured = run(
        BIN / "zebro-lab", "rig", "run", PLAN, "--rig", "sim", "--fast", "--seed", seed,
        "--data", data,
    )  # fmt: skip
    fitted = run(BIN / "calibrate-slip", data, "--curvature", "peak", "--gain-sd", GAIN_SD,
                 "--out", out)  # fmt: skip
    curve = read_slip(out)
    miss = curve.values - THESIS_VALUES
    square = float(miss @ np.linalg.solve(curve.covariance, miss))
    sd = np.sqrt(np.diag(curve.covariance))
    return np.append(miss / sd, square), sd / np.abs(THESIS_VALUES), f"{measured}, {fitted}"


def main(seeds: int) -> None:
    """Print the table."""
    print(f"| seed | {' | '.join(NAMES)} | chi-square of {len(NAMES)} | exit codes | s |")
    print("|---|" + "---:|" * (len(NAMES) + 3))
    found, widths = [], []
    for seed in range(seeds):
        began = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            misses, width, codes = calibrate(seed, Path(folder))
        found.append(misses)
        widths.append(width)
        cells = " | ".join(f"{value:+.2f}" for value in misses[:-1])
        print(f"| {seed} | {cells} | {misses[-1]:.2f} | {codes} | "
              f"{time.monotonic() - began:.0f} |", flush=True)  # fmt: skip
    total, freedom = float(np.sum(found, axis=0)[-1]), len(NAMES) * seeds
    print(f"\nall: {total:.1f} of {freedom}, p = {chi2.sf(total, freedom):.3g}; median sd "
          + ", ".join(f"{n} {w:.2%}" for n, w in zip(NAMES, np.median(widths, axis=0),
                                                    strict=True)))  # fmt: skip


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
