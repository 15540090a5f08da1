# SPDX-License-Identifier: MIT
"""Whether `validate` names the clock of a track that is wrong.

    python -m benchmarks.accuracy.planted_clock_faults 20

SIMULATED: walks of an independent rigid-body engine (reference data, `ZEBRO_LAB_SHARED` or the
folder `shared` beside the checkout), predicted by our model from their logged leg angles. A track
has a pose of the engine's walk every 2 s, in a floor frame of its own, with errors of its
photographs and of its scale, and times by a clock that is behind. The robot stands before and
after the walk; in the last rows it walks all the time, and the motion need not tell. Printed is how
often the clock is named, within how much, and of how many walks it is said to be not testable.
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
import pandas as pd

from benchmarks.accuracy.engine_walks import SHARED, by_dynamics, read_walk
from benchmarks.tables import print_table
from tracking.photos.workers import NoProgress
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.validation.stage import validate

BEHIND = (0.0, 1.0, 2.0)
"""By how much the track's clock is behind the prediction's [s]."""
STOOD = 6.0
"""Time the robot stands before and after its walk [s]."""
INTERVAL = 2.0
PLACE_SD, YAW_SD, SCALE_SD = 2e-3, np.radians(0.3), 3e-3
COLUMNS = ("x", "y", "yaw")


class Job(NamedTuple):
    """A track to draw and judge."""

    behind: float
    stands: bool
    seed: int


@dataclass(frozen=True)
class Said:
    """What is said of the track's clock: that it is wrong, that it is not testable, or neither."""

    wrong: bool
    not_testable: bool


@cache
def predicted_and_true(number: int) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return our path and the engine's of one of its walks, t [s], x, y [m] and yaw [rad]."""
    files = sorted((SHARED / "virtual-world/walks").glob("*.json"))
    if not files:
        raise SystemExit(f"no walks under {SHARED}; set ZEBRO_LAB_SHARED to the reference data")
    one = read_walk(files[number % len(files)])
    path = by_dynamics(one)
    ours = pd.DataFrame(dict(zip(COLUMNS, (*path.position[:, :2].T, path.yaw), strict=True)))
    ours.insert(0, "t", path.t)
    return ours, pd.DataFrame({name: one.truth[name] for name in ("t", *COLUMNS)})


def standing(walk: pd.DataFrame) -> pd.DataFrame:
    """Let the robot stand before and after a walk, for `STOOD` each, from time 0 on."""
    t = np.arange(0.0, walk["t"].iloc[-1] + 2 * STOOD, 0.01)
    return pd.DataFrame(
        {"t": t} | {name: np.interp(t - STOOD, walk["t"], walk[name]) for name in COLUMNS}
    )


def tracked(walk: pd.DataFrame, *, behind: float, rng: np.random.Generator) -> pd.DataFrame:
    """Draw the track of a walk by a clock that is behind [s]."""
    t = np.arange(rng.uniform(0, INTERVAL), walk["t"].iloc[-1], INTERVAL)
    x, y, yaw = (np.interp(t, walk["t"], walk[name]) for name in COLUMNS)
    turn, scale = rng.uniform(-np.pi, np.pi), 1 + rng.normal(0, SCALE_SD)
    floor = scale * np.exp(1j * turn) * (x + 1j * y)
    error = rng.normal(0, 1, (3, len(t))) * [[PLACE_SD], [PLACE_SD], [YAW_SD]]
    seen = {"x": floor.real + error[0], "y": floor.imag + error[1], "yaw": yaw + turn + error[2]}
    return pd.DataFrame({"t": t - behind} | seen)


def judged(job: Job) -> Said:
    """Draw a track, validate its prediction against it, and return what is said of its clock."""
    ours, true = predicted_and_true(job.seed)
    if job.stands:
        ours, true = standing(ours), standing(true)
    seen = tracked(true, behind=job.behind, rng=np.random.default_rng(7000 + job.seed))
    with TemporaryDirectory() as folder:
        path, track = Path(folder, "path.csv"), Path(folder, "seen.csv")
        ours.to_csv(path, index=False)
        seen.to_csv(track, index=False)
        request = ValidateRequest(predicted=(path,), track=(track,), out=Path(folder, "out"))
        notes = " | ".join(validate(request, NoProgress()).runs[0].notes)
    return Said("the track's clock is" in notes, "the track's clock: not testable" in notes)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n")[0])
    parser.add_argument("tries", type=int, nargs="?", default=20)
    tries = parser.parse_args().tries
    rows = list(product((True, False), BEHIND))
    jobs = [Job(behind, stands, n) for stands, behind in rows for n in range(tries)]
    with ProcessPoolExecutor() as pool:
        said = list(pool.map(judged, jobs, chunksize=4))
    table = []
    for k, (stands, behind) in enumerate(rows):
        some = said[k * tries : (k + 1) * tries]
        table.append((
            "stands before and after" if stands else "walks all the time", f"{behind:g} s",
            f"{sum(each.wrong for each in some)} of {tries}",
            f"{sum(each.not_testable for each in some)}",
        ))  # fmt: skip
    print_table(("robot", "clock behind", "named", "not testable"), *table)


if __name__ == "__main__":
    main()
