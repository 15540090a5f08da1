# SPDX-License-Identifier: MIT
"""Compile the loops that take longest, so that they are in the cache before tests need them.

Of workers that run tests side by side, several would compile the loops that all of them need. Here
two processes share the loops, so that each is compiled once. With all in the cache this takes two
seconds.

Usage, in the folder `tests`: python -m support.compile_loops SHARE; SHARE is a key of `SHARES`.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np

from model.gait.inexact_log import InexactLog
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.robot import Robot
from model.slip.thesis_curve import thesis_curve
from model.walk.dynamics import DynamicsOptions, walk
from model.walk.ensemble import WalkDraw, walk_ensemble
from model.walk.ground import FLAT, with_slope
from model.walk.slip import Slip
from model.walk_models import MODELS, ModelRun

GAIT = tripod_reference(tripod_angles(np.radians(45.0), 1.2), 1.0)
SLIP = Slip(thesis_curve(), source="thesis")
TABLE = SLIP.traction_table(weight=20.0)
OPTIONS = DynamicsOptions(dt=0.005)
TIMES = np.arange(0.0, 0.1, 0.005)


def compile_simple_models() -> None:
    """Reconstruct counted angles, and walk by the thesis's model and without slip."""
    count = np.radians(3.6)
    t = np.arange(0.0, 2.0, 0.01)
    log = InexactLog(t, count * np.round(GAIT.angles(t) / count), count)
    log.smooth(np.random.default_rng(1))
    for name in ("thesis", "no-slip"):
        model = MODELS[name]
        model.run(ModelRun(Robot(), GAIT, SLIP, TIMES[-1], model.dt))


def compile_dynamics() -> None:
    """Walk by the project's model: draws, a gait, and one on a slope."""
    log = SampledReference(TIMES, GAIT.angles(TIMES))
    walk_ensemble([WalkDraw(Robot(), log, TABLE)] * 2, TIMES, options=OPTIONS)
    for ground in (FLAT, with_slope(FLAT, 0.05, 0.0)):
        walk(Robot(), GAIT, TABLE, duration=TIMES[-1], ground=ground, options=OPTIONS)


SHARES = {"simple models": compile_simple_models, "dynamics": compile_dynamics}


def compile_loops() -> None:
    """Compile all loops, by one process for each share; what fails is left to the tests."""
    command = [sys.executable, "-m", "support.compile_loops"]
    started = [
        subprocess.Popen([*command, share], cwd=Path(__file__).parents[1]) for share in SHARES
    ]
    for process in started:
        process.wait()


if __name__ == "__main__":
    SHARES[sys.argv[1]]()
