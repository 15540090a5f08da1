# SPDX-License-Identifier: MIT
"""Commands run in this process, on the bundled walk."""

import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest

from support.bundled_walk import SOME, WALK
from zebro_lab.track.request import TrackRequest


@pytest.fixture
def files(tmp_path) -> Path:
    """Return a folder with camera.toml and floor.toml for the bundled photographs."""
    for name in ("camera.toml", "floor.toml"):
        shutil.copy(WALK / name, tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def bench(tmp_path_factory) -> Path:
    """Return a folder with camera.toml and floor.toml of the true camera, and some photographs."""
    folder = tmp_path_factory.mktemp("bench")
    truth = tomllib.loads((WALK / "truth.toml").read_text())
    camera = truth["camera"]
    (folder / "camera.toml").write_text(
        "".join(f"{key} = {camera[key]}\n" for key in ("size", "focal", "centre", "distortion"))
    )
    lines = ["side = 0.15", "[markers]"]
    for marker in truth["floor_markers"]:
        x, y, _ = np.mean(marker["corners"], axis=0)
        lines.append(f"{marker['id']} = {{ x = {x}, y = {y} }}")
    (folder / "floor.toml").write_text("\n".join(lines))
    (folder / "photos").mkdir()
    for number in SOME:
        shutil.copy(WALK / f"photos/simulated_{number}.jpg", folder / "photos")
    return folder


@pytest.fixture
def request_(bench, tmp_path) -> TrackRequest:
    """Return what is asked of the bundled photographs, with an empty folder to write."""
    return TrackRequest(
        bench / "photos", bench / "camera.toml", bench / "floor.toml",
        robot=WALK / "robot.toml", out=tmp_path / "track",
    )  # fmt: skip


@pytest.fixture
def undrawn(monkeypatch):
    """Leave out the pictures, which take longer than the tracking of so few photographs."""
    monkeypatch.setattr("zebro_lab.track.pictures.draw_track", lambda *_, **__: None)
