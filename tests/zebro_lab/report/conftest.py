# SPDX-License-Identifier: MIT
"""A walk with every part of a report, which tests of reports share."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

from support.report_pages import HOSTILE, SLIP, metrics, part, write_json


@pytest.fixture
def walk(tmp_path) -> Path:
    """Return a folder with every part of a walk and a calibration, all numbers random."""
    rng = np.random.default_rng(7)
    run = tmp_path / "run"
    write_json(run / "run.json", {
        "kind": "walk", "label": HOSTILE, "source": "sim:robot", "streams": {"/legs/raw": 1234},
        "counters": {"legs": {"received": 1234, "lost": 56, "dropped": 7}},
    })  # fmt: skip
    rows = {"prediction": metrics(rng), "stand still": {**metrics(rng), "radius_m": None}}
    imu = {f"{a}_{k}_deg": float(rng.uniform(0, 1)) for a in ("roll", "pitch")
           for k in ("bias", "rms", "rms_unbiased", "swing")}  # fmt: skip
    part(run / "validation", "validation", rng, pictures=["run.png", "run.photos.png"],
         runs={"run": rows}, imu={"run": imu})  # fmt: skip
    part(run / "track", "track", rng, pictures=["map.png"], photos=16, tracked=15,
         left_out={"p<3>.jpg": "no marker"}, floor_misfit_px=0.02, times="EXIF")  # fmt: skip
    law = hashlib.sha256(SLIP.encode()).hexdigest()
    part(run / "prediction", "predict", rng, pictures=["band.png"], inputs={"slip.toml": law},
         settings={"model": "dynamics", "slip": {"named": "calibration", "source": "sim:rig"},
                   "leg_angles": "sim:robot", "band": {"draws": 300}})  # fmt: skip
    calibration = tmp_path / "calibration"
    part(calibration, "calibration", rng, pictures=["curves.png", "corner.png"])
    (calibration / "slip.toml").write_text(SLIP)
    (calibration / "summary.csv").write_text(
        'parameter,contraction,r_hat,ess_bulk,prior\nshape,0.9911,1.0007,9796,"uniform(1, 2)"\n'
    )
    return run
