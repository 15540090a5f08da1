# SPDX-License-Identifier: MIT
"""A drive through space, and its files as other programs write them."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

HEADER = (
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []"
)


def drive(n: int = 60, *, noise: float = 0.0, seed: int = 1):
    """Return times [s], positions [m] and rotations of a drive of 12 m with bends and hills."""
    t = 0.1 * np.arange(n)
    s = 12.0 * t / t[-1]
    yaw = 1.2 * np.sin(0.6 * s)
    heading = np.column_stack([np.cos(yaw), np.sin(yaw)])
    step = np.diff(s, prepend=0.0)[:, None]
    position = np.column_stack([np.cumsum(heading * step, axis=0), 0.1 * np.sin(s)])
    rng = np.random.default_rng(seed)
    position += rng.normal(0.0, noise, position.shape)
    tilt = np.column_stack([yaw, 0.05 * np.cos(s), 0.03 * np.sin(2 * s)])
    rotation = Rotation.from_euler("ZYX", tilt + rng.normal(0.0, 0.1 * noise, tilt.shape))
    return t, position, rotation


def tum(t, position, rotation, separator: str = " ") -> str:
    rows = np.column_stack([t, position, rotation.as_quat()])
    return "".join(separator.join(f"{v:.17g}" for v in row) + "\n" for row in rows)


def euroc(t, position, rotation, header: str = HEADER) -> str:
    quaternion = np.roll(rotation.as_quat(), 1, axis=1)
    rows = [
        ",".join([f"{round(stamp * 1e9)}", *(f"{v:.17g}" for v in row)])
        for stamp, row in zip(t, np.column_stack([position, quaternion]), strict=True)
    ]
    return "\n".join([*([header] if header else []), *rows]) + "\n"


def kitti(position, rotation) -> str:
    rows = np.concatenate([rotation.as_matrix(), position[:, :, None]], axis=2).reshape(-1, 12)
    return "".join(" ".join(f"{v:.17g}" for v in row) + "\n" for row in rows)


def written(file: Path, text: str) -> Path:
    file.write_text(text)
    return file
