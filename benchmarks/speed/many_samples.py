# SPDX-License-Identifier: MIT
"""Time `calibrate-slip` on many samples, and measure its memory.

python -m benchmarks.speed.many_samples [SAMPLES ...]

Writes a *simulated* sweep of the bundled plan for each number of samples (default: 1, 10 and 100
million) as one Parquet table into a temporary folder, run by run, fits it by the command with
its defaults, and prints the time, the largest resident memory of the process, and the headline.
"""

import os
import sys
import tempfile
import time
import tomllib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from benchmarks.machine import describe_machine
from benchmarks.tables import print_table
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.sweep import SweepPlan, draw_imperfections, simulate_sweep
from zebro_lab.main import slip_app
from zebro_lab.terminal.ending import run

DURATION = 4.0  # of a run [s]
COLUMNS = """source = "sim:bench"
[constants]
radius_leg = "35 mm"
radius_ground = "120 mm"
[columns.t]
name = "t"
unit = "s"
[load_cell]
zero_stability = 0.1
gain_sd = 0.005
"""


def write_sweep(file: Path, samples: int) -> int:
    """Write a simulated sweep of about so many samples; return their number."""
    plan = SweepPlan()
    rate = samples / (plan.n_runs * DURATION)
    rng = np.random.default_rng(2020)
    errors = draw_imperfections(rng)
    writer, written, number = None, 0, 0
    for load in plan.loads:
        for slip in plan.slips:
            one = SweepPlan(slips=(slip,), loads=(load,), duration=DURATION, rate=rate)
            sweep = simulate_sweep(
                THESIS_LAW, THESIS_VALUES, plan=one, imperfections=errors, rng=rng
            )
            table = pd.DataFrame(sweep.table).assign(run=number)
            part = pa.Table.from_pandas(table, preserve_index=False)
            writer = writer or pq.ParquetWriter(file, part.schema)
            writer.write_table(part)
            written, number = written + len(table), number + 1
    if writer is not None:
        writer.close()
    return written


def fit(folder: Path) -> tuple[float, float, str]:
    """Fit the table of a folder by the command; return seconds, memory in MB, and the headline."""
    out = folder / "calibration"
    began = time.perf_counter()
    process = os.fork()
    if process == 0:
        sys.argv = ["calibrate-slip", str(folder / "sweep.parquet"), "--out", str(out)]
        sys.stdout = sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115
        try:
            run(slip_app)
        except SystemExit as ended:
            os._exit(int(ended.code or 0))
        os._exit(0)
    _, status, used = os.wait4(process, 0)
    seconds = time.perf_counter() - began
    if os.waitstatus_to_exitcode(status) not in (0, 3):
        return seconds, used.ru_maxrss / 1024, f"failed, exit {os.waitstatus_to_exitcode(status)}"
    content = tomllib.loads((out / "slip.toml").read_text())
    return seconds, used.ru_maxrss / 1024, str(content["verdict"]["headline"])


def main(sizes: Sequence[int]) -> None:
    """Print one row for each number of samples."""
    print(f"Machine: {describe_machine()}.\n")
    rows = []
    for size in sizes:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "columns.toml").write_text(COLUMNS)
            written = write_sweep(folder / "sweep.parquet", size)
            packed = (folder / "sweep.parquet").stat().st_size / 1e6
            seconds, memory, headline = fit(folder)
            rows.append((f"{written:,}", f"{packed:,.0f}", f"{seconds:.0f}", f"{memory:,.0f}",
                         headline))  # fmt: skip
            print(" ".join(rows[-1]), flush=True)
    print()
    print_table(("simulated samples", "file [MB]", "seconds", "memory [MB]", "verdict"), *rows)


if __name__ == "__main__":
    main([int(float(word)) for word in sys.argv[1:]] or [10**6, 10**7, 10**8])
