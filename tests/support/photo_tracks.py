# SPDX-License-Identifier: MIT
"""A track of two photographs of the bundled walk."""

import json
import shutil
from pathlib import Path

import pandas as pd

from zebro_lab.files.provenance import file_hash

DATA = Path(__file__).parents[2] / "datasets/walk-sim"


SHOWN = ("simulated_03.jpg", "simulated_12.jpg")


def write_photo_track(tmp_path):
    """Write a track of two photographs, made of their true poses; return its folder."""
    truth = pd.read_csv(DATA / "photos.csv").set_index("photo").loc[list(SHOWN)].reset_index()
    folder = tmp_path / "track"
    folder.mkdir()
    table = truth.rename(columns={"t": "t_s", "x": "x_m", "y": "y_m", "yaw": "yaw_rad"})
    table[["t_s", "x_m", "y_m", "yaw_rad", "photo"]].to_csv(folder / "track.csv", index=False)
    shutil.copy(DATA / "floor.toml", folder / "floor.toml")
    camera = shutil.copy(DATA / "camera.toml", tmp_path / "camera.toml")
    for name in SHOWN:
        shutil.copy(DATA / "photos" / name, tmp_path / name)
    read = [DATA / "floor.toml", camera, *(tmp_path / name for name in SHOWN)]
    manifest = {
        "schema": 1, "kind": "track", "source": "sim:photographs",
        "inputs": {str(file): file_hash(file) for file in read},
    }  # fmt: skip
    (folder / "manifest.json").write_text(json.dumps(manifest))
    return folder
