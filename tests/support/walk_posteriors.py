# SPDX-License-Identifier: MIT
"""A posterior after walks that is sure of its answer."""

import numpy as np
import pandas as pd

from model.gait import tripod_angles, tripod_reference
from model.walk_fit.posterior import WalkPosterior
from model.walk_fit.prior import LINEAR, NAMES, WRONG, WalkPrior, WrongLeg, all_cases
from support.watchers import Nobody
from zebro_lab.calibration.walks_folder import WalksToWrite, read_stored_walks, write_walks
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.walk.request import BandRequest, ModelRequest, PredictRequest
from zebro_lab.walk.stage import predict

STEERING = LINEAR[0]


GRIP = NAMES.index("grip")


KNOCKED = WrongLeg(2, walk=1)


OFF = np.radians(5.0)


def posterior_of(case, *, steering=0.0):
    """Return a posterior that is sure: leg 3 off by 5 degrees in `case`, all else as described."""
    cases = all_cases(2)
    values = np.zeros((40, WRONG + 1))
    values[:, WRONG], values[:, STEERING] = OFF, steering
    values[:, GRIP] = WalkPrior().grip_sd * np.linspace(-1.7, 1.7, len(values))  # not informed
    n = len(values)
    return WalkPosterior(
        prior=WalkPrior(),
        walks=("one", "two"),
        cases=cases,
        values=values,
        case=np.full(n, cases.index(case)),
        weight=np.full(n, 1 / n),
        best=values[20],
        best_case=case,
        misfit=(0.9, 1.1),
    )


SLIP_TOML = """
schema = 1
source = "sim:rig-sweep"
slip_definition = "material"
law = { name = "coulomb-stribeck", stribeck = false }
[parameters]
slip_stiffness = { mean = 20.0 }
friction = { mean = 0.4 }
[covariance]
matrix = [[1.0, 0.0], [0.0, 0.0001]]
[tested]
normal_force = [2.0, 13.0]
slip_ratio = [0.0, 1.0]
"""


def write_legs(tmp_path):
    """Write two leg logs; return the files."""
    files = []
    for i, steering in enumerate((1.0, 1.2)):
        gait = tripod_reference(tripod_angles(np.radians(50.0), steering), 2.0)
        t = np.arange(0.0, 6.0, 0.01)
        table = pd.DataFrame(
            {"t": t} | {f"theta{k + 1}": a for k, a in enumerate(gait.angles(t).T)}
        )
        files.append(tmp_path / f"legs{i}.csv")
        table.to_csv(files[-1], index=False)
    return files


def write_calibration(tmp_path):
    """Write a calibration without walks; return its folder."""
    folder = tmp_path / "calibration"
    folder.mkdir()
    (folder / "slip.toml").write_text(SLIP_TOML)
    return folder


def stored(calibration, legs, posterior, *, draw=lambda _: None):
    """Store a posterior beside a calibration, without pictures, and read it back."""
    slip = calibration / "slip.toml"
    write_walks(
        calibration,
        WalksToWrite(
            posterior=posterior, left_out={}, robot=RobotFile(), logs=tuple(legs),
            inputs=(slip, *legs), settings={"seed": 1}, source="sim:test", notes=("a note",),
        ),
        draw=draw,
    )  # fmt: skip
    return read_stored_walks(slip)


def predict_log(tmp_path, log, slip, *, name="prediction", robot=None, draws=0, model="dynamics"):
    """Predict a leg log; return the walk."""
    request = PredictRequest(
        log,
        tmp_path / name,
        model=ModelRequest(slip=slip, model=model, robot=robot, band=BandRequest(draws)),
    )
    return predict(request, Nobody())
