# SPDX-License-Identifier: MIT
"""Predict the bundled, SIMULATED walk from its leg log and judge it against its tracked path.

Usage: .venv/bin/python examples/validate.py
"""

from datetime import UTC, datetime
from pathlib import Path
from tempfile import mkdtemp

import zebro_lab as zl

walk = Path(__file__).parents[1] / "datasets" / "walk-sim"
out = Path(mkdtemp())
zl.predict_walk(
    walk / "legs.csv", slip="coulomb:0.38", robot=walk / "robot.toml",
    columns=walk / "columns.toml", draws=100, out=out / "prediction",
)  # fmt: skip
zl.track_photos(
    walk / "photos", out=out / "track", start=datetime(2020, 6, 1, 12, tzinfo=UTC),
    camera=walk / "camera.toml", floor=walk / "floor.toml", robot=walk / "robot.toml",
)  # fmt: skip

done = zl.validate_walks((out / "prediction", out / "track"), out=out / "validation")
for row in done.runs[0].rows:
    print(f"{row.name:<14} position error {1000 * row.errors.ate:6.1f} mm rms")
print(f"pictures and tables in {out / 'validation'}")
