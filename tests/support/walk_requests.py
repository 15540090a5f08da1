# SPDX-License-Identifier: MIT
"""Small walks, and leg logs of gaits."""

import numpy as np
import pandas as pd

from model.gait import tripod_angles, tripod_reference
from zebro_lab.robot.gait_request import GaitRequest
from zebro_lab.robot.leg_log import ANGLES
from zebro_lab.walk.request import ModelRequest, WalkRequest


def request(out, **model) -> WalkRequest:
    """Return a request of a walk of four seconds to the left."""
    gait = GaitRequest(steering=1.3, direction="left")
    return WalkRequest(gait, 4.0, out, ModelRequest(**{"slip": "coulomb:0.4", **model}))


def write_log(folder, *, start=0.0, sign=1, **gait):
    """Write the leg angles of that walk, wrapped to a turn."""
    reference = tripod_reference(tripod_angles(np.radians(50), 1.3), 2.0, **gait)
    t = np.linspace(0, 4, 801)
    table = pd.DataFrame(sign * reference.angles(t) % (2 * np.pi), columns=list(ANGLES))
    table.insert(0, "t", t + start)
    table.to_csv(folder / "legs.csv", index=False)
    return folder / "legs.csv"
