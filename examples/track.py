# SPDX-License-Identifier: MIT
"""Track the robot in the bundled, SIMULATED photographs of a walk.

Usage: .venv/bin/python examples/track.py [FOLDER]
"""

import sys
from datetime import UTC, datetime
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

import zebro_lab as zl

walk = Path(__file__).parents[1] / "datasets" / "walk-sim"
out = Path(sys.argv[1] if len(sys.argv) > 1 else mkdtemp()) / "track"
zl.track_photos(
    walk / "photos", out=out, start=datetime(2020, 6, 1, 12, tzinfo=UTC),
    camera=walk / "camera.toml", floor=walk / "floor.toml", robot=walk / "robot.toml",
)  # fmt: skip

track = zl.read_track(out)
for t, (x, y, yaw), covariance in zip(
    track.poses.t, track.poses.states, track.covariance, strict=True
):
    sd = 1000 * np.sqrt(covariance[0, 0])
    print(f"{t:5.1f} s  x {x:.4f} m  y {y:.4f} m  yaw {np.degrees(yaw):6.2f} deg  sd {sd:.2f} mm")
print(f"{len(track.poses)} poses in {out}")
