# SPDX-License-Identifier: MIT
"""A lab's own files that tests of import share."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from support.imported_files import COLUMNS, THETA, YAW, T


@pytest.fixture
def files(tmp_path) -> Path:
    """Return a folder of a lab's own files, in its own names and units."""
    folder = tmp_path / "lab"
    folder.mkdir()
    legs = {"time_ms": 1e3 * T, "fl": np.degrees(THETA[:, 0]), "fr": -np.degrees(THETA[:, 1])}
    legs |= {f"theta{leg}": THETA[:, leg - 1] for leg in range(3, 7)}
    pd.DataFrame(legs).to_csv(folder / "legs.csv", index=False)
    imu = {"t": T, "roll": 0.1 * np.sin(T), "pitch": 0.2 * np.cos(T), "yaw_rate": 5.0 + 0 * T}
    pd.DataFrame(imu).to_csv(folder / "imu.csv", index=False)
    track = {"t": T[::20], "east_mm": 1e3 * np.sin(YAW), "north_mm": 1e3 * (1 - np.cos(YAW)),
             "yaw": YAW, "cov_xx": 1e-6, "cov_xy": 0.0, "cov_xyaw": 0.0, "cov_yy": 4e-6,
             "cov_yyaw": 0.0, "cov_yawyaw": 1e-4}  # fmt: skip
    pd.DataFrame(track).to_csv(folder / "track.csv", index=False)
    rows = [f"{t} {np.sin(y)} {1 - np.cos(y)} 0.06 0 0 {np.sin(y / 2)} {np.cos(y / 2)}"
            for t, y in zip(T[::20], YAW, strict=True)]  # fmt: skip
    (folder / "path.tum").write_text("# t x y z qx qy qz qw\n" + "\n".join(rows))
    (folder / "robot.toml").write_text("mass = 3.0\n[legs]\noffset_deg = [9, 0, 0, 0, 0, 0]\n")
    (folder / "columns.toml").write_text(COLUMNS)
    return folder
