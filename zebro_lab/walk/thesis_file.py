# SPDX-License-Identifier: MIT
"""Write `thesis.csv`: the quantities of the thesis's model, beside the `path.csv` of its walk."""

from pathlib import Path

import numpy as np

from model.arrays import Array
from model.leg import wrap_angle
from model.robot import Robot
from model.thesis.frames import contact_forces, contact_frames, hip_frames
from model.thesis.path import ThesisPath
from model.walk.path import WalkPath
from zebro_lab.walk.folder import by_axis, leg_columns, write_rows

_DIGITS = "%.8g"  # to 1e-7 m in a walk of 10 m
_EVERY = 0.01  # s between two rows, of 1 kB each
_PART = 10_000  # samples
_COORDINATES = ("x", "y", "z", "theta_r", "theta_p", "theta_y")


COLUMNS = (
    "t", "theta_r", "theta_p", "theta_y",
    *(f"{name}_rate" for name in _COORDINATES), *(f"{name}_acceleration" for name in _COORDINATES),
    *leg_columns("phi", "phi_rate", "z_h", "f_g", "v_R", "v_C", "v_H"),
    *leg_columns("hip_x", "hip_y", "hip_z", "contact_x", "contact_y", "contact_z"),
    *leg_columns("contact_lean", "ground_x", "ground_y", "ground_z"),
)  # fmt: skip
"""The columns of `thesis.csv`, in order."""


def write_thesis(file: Path, path: WalkPath, robot: Robot) -> None:
    """Write the quantities of the thesis's model as CSV in SI, a row about every 10 ms.

    Nothing is written if the walk is of another model.

    Frames and forces are computed and written part by part, since all at once of a long walk they
    take more memory than the walk.

    Args:
        file: File to write; an existing one is overwritten.
        path: The walk; NaN, for what a leg in the air does not have, becomes an empty cell.
        robot: The robot that walked.
    """
    if not isinstance(path, ThesisPath):
        return
    if len(path.t) > 1:
        steps = max(round(_EVERY / float(path.t[1] - path.t[0])), 1)
        path = path.part(slice(None, None, steps))
    parts = (path.part(slice(first, first + _PART)) for first in range(0, len(path.t), _PART))
    values = (_values(part, robot) for part in parts)
    write_rows(file, COLUMNS, values, [_DIGITS] * len(COLUMNS))


def _values(path: ThesisPath, robot: Robot) -> Array:
    """Return the numbers of `COLUMNS` at the samples of a path, shape (n, len(COLUMNS))."""
    origins = (hip_frames(robot, path)[..., :3, 3], contact_frames(robot, path)[..., :3, 3])
    return np.column_stack([
        path.t, path.angles, path.rates, path.acceleration,
        path.phi, path.phi_rate, path.hip_height, path.static_load,
        path.leg_speed, path.contact_speed, path.hip_speed,
        *(by_axis(each) for each in origins),
        wrap_angle(path.theta + path.phi - np.pi / 2),
        by_axis(contact_forces(path)),
    ])  # fmt: skip
