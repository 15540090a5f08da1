# SPDX-License-Identifier: MIT
"""Walks simulated with other numbers than they are predicted with, and their tracks."""

import numpy as np
import pandas as pd

from model.gait import tripod_angles, tripod_reference
from model.robot import Robot
from model.walk.ensemble import WalkDraw, planar_walk
from model.walk.traction import VelocityCoulomb
from support.watchers import Nobody
from zebro_lab.validation.request import ValidateRequest
from zebro_lab.walk.request import BandRequest, ModelRequest, PredictRequest
from zebro_lab.walk.stage import predict

STEP = np.radians(3.6)


DURATION = 12.0


def gait(steering):
    """Return a tripod gait."""
    return tripod_reference(tripod_angles(np.radians(50.0), steering), 2.0)


def write_walk_data(folder, *, steering=1.2, offset_deg=0.0, seed=3):
    """Write a simulated walk's counted leg log and its track; return both files."""
    reference = gait(steering)
    robot = Robot(leg_offset=np.radians(offset_deg) * np.array([0, 1, 0, 0, 0, 0]))
    table = VelocityCoulomb(0.38).table(weight=robot.mass * 9.81)
    true = planar_walk(WalkDraw(robot, reference, table), duration=DURATION).poses
    t = np.arange(0, DURATION, 0.01)
    counted = STEP * np.round(reference.angles(t) / STEP)
    legs = pd.DataFrame({"t": t} | {f"theta{i + 1}": counted[:, i] for i in range(6)})
    legs.to_csv(folder / "legs.csv", index=False)
    rng = np.random.default_rng(seed)
    seen = np.arange(0.5, DURATION - 0.1, 1.0)
    x, y, yaw = true.at(seen).states.T
    c, s = np.cos(0.7), np.sin(0.7)  # the floor's frame is not the robot's
    noise = rng.normal(0, [[0.002], [0.002], [0.005]], (3, len(seen)))
    track = pd.DataFrame({
        "t_s": seen, "x_m": 1 + c * x - s * y + noise[0], "y_m": s * x + c * y + noise[1],
        "yaw_rad": yaw + 0.7 + noise[2], "cov_xx": 4e-6, "cov_xy": 0.0, "cov_xyaw": 0.0,
        "cov_yy": 4e-6, "cov_yyaw": 0.0, "cov_yawyaw": 2.5e-5,
    })  # fmt: skip
    track.to_csv(folder / "track.csv", index=False)
    return folder / "legs.csv", folder / "track.csv"


def predicted(folder, legs, *, draws=60, name="prediction"):
    """Predict a leg log; return the walk folder."""
    request = PredictRequest(
        legs,
        folder / name,
        model=ModelRequest(slip="coulomb:0.38", band=BandRequest(draws)),
    )
    predict(request, Nobody())
    return folder / name


def request_of(pairs, out, **options):
    """Return the request of a validation of predictions, each with its track."""
    predicted, track = zip(*pairs, strict=True)
    return ValidateRequest(predicted=predicted, track=track, out=out, **options)


def rows_of(validated):
    """Return the errors of the first walk by model."""
    return {row.name: row for row in validated.runs[0].rows}
