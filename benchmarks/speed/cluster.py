# SPDX-License-Identifier: MIT
"""Replicates of a study in one process and on a Dask cluster of which a worker is killed.

python -m benchmarks.speed.cluster [REPLICATES] [--workers N]

A cluster of processes is started on this machine (4 by default; it needs the extra "cluster"). The
replicates of simulation-based calibration, of a sweep with 16 slip ratios at four loads, are
computed there, and one worker is killed after the first few results; then in this process alone.
Prints wall times, and whether the numbers are the same. All data are simulated.
"""

import argparse
import os
import signal
import time
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.machine import describe_machine
from benchmarks.tables import print_table
from model.bayes.blocks import block_means
from model.bayes.rig_errors import RADIUS_TOLERANCE, RigErrors, radius_ratio_sd
from model.mapping import Mapper
from model.slip.thesis import THESIS_LAW, THESIS_VALUES
from model.study.design import study_design
from model.study.ranks import RankReplicate, RankStudy, Replicate, rank_replicate
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan, simulate_sweep
from zebro_lab.study.layout import TWIN_CELL
from zebro_lab.workers.cluster import Cluster, open_cluster
from zebro_lab.workers.processes import Processes

KILLED_AFTER = 5  # results
BLOCK = 50  # samples
SEED = 1


@dataclass(frozen=True)
class Mapped:
    """Replicates and the wall time that they took [s]."""

    replicates: list[RankReplicate]
    seconds: float


def sweep_study() -> RankStudy:
    """Lay out a sweep of 16 slip ratios at four loads, 64 runs of 5 blocks."""
    plan = SweepPlan(slips=tuple(np.linspace(0.0, 1.0, 16).tolist()))
    sweep = simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=TYPICAL_RIG,
        rng=np.random.default_rng(0),
    )  # fmt: skip
    errors = RigErrors(radius_ratio_sd(plan.radius_leg, plan.radius_ground, RADIUS_TOLERANCE))
    blocks = block_means(sweep.samples, BLOCK)
    design = study_design(blocks, THESIS_LAW, load_cell=TWIN_CELL, rig_errors=errors)
    return RankStudy(design, design)


def mapped(workers: Mapper, study: RankStudy, n: int, *, kill: int | None = None) -> Mapped:
    """Compute n replicates; end the process `kill` after `KILLED_AFTER` of them."""
    began = time.perf_counter()
    found: list[RankReplicate] = []
    for each in workers.map(rank_replicate, study, [Replicate(SEED, i) for i in range(n)]):
        found.append(each)
        if kill is not None and len(found) == min(KILLED_AFTER, n - 1):
            os.kill(kill, signal.SIGKILL)
    return Mapped(found, time.perf_counter() - began)


@contextmanager
def local_cluster(workers: int) -> Generator[Cluster]:
    """Start a cluster of processes on this machine, connect to it, and end it."""
    from distributed import LocalCluster

    started: Any = LocalCluster(  # its stub knows no context and no address
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0"
    )
    with started as local, open_cluster(local.scheduler_address) as cluster:
        yield cluster


def main(n: int, workers: int) -> bool:
    """Print both wall times; return whether the numbers are the same."""
    os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")  # as in commands
    study = sweep_study()
    with local_cluster(workers) as cluster:
        told: Any = cluster.client.run(os.getpid)
        pids = list(told.values())
        spread = mapped(cluster, study, n, kill=pids[0])
    alone = mapped(Processes(1), study, n)
    same = spread.replicates == alone.replicates
    print(describe_machine(), end="\n\n")
    print_table(
        (f"{n} replicates", "wall time [s]", "a replicate [s]"),
        ("one process", f"{alone.seconds:.0f}", f"{alone.seconds / n:.2f}"),
        (
            f"cluster of {workers} processes, one killed after {min(KILLED_AFTER, n - 1)}",
            f"{spread.seconds:.0f}",
            f"{spread.seconds / n:.2f}",
        ),
    )
    print(f"the numbers are {'the same' if same else 'DIFFERENT'}")
    return same


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="replicates on a cluster and in one process")
    parser.add_argument("replicates", type=int, nargs="?", default=40)
    parser.add_argument("--workers", type=int, default=4)
    given = parser.parse_args()
    raise SystemExit(0 if main(given.replicates, given.workers) else 1)
