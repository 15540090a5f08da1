# SPDX-License-Identifier: MIT
"""Commands run in this process, on the bundled walk."""

import shutil
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from support.bundled_walk import SOME, WALK, Nobody
from zebro_lab.track.request import TrackRequest
from zebro_lab.track.stage import TrackResult, track


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


def asked(bench: Path, out: Path) -> TrackRequest:
    """Return what is asked of the bundled photographs."""
    return TrackRequest(
        bench / "photos", bench / "camera.toml", bench / "floor.toml",
        robot=WALK / "robot.toml", out=out,
    )  # fmt: skip


@pytest.fixture
def request_(bench, tmp_path) -> TrackRequest:
    """Return what is asked of the bundled photographs, with an empty folder to write."""
    return asked(bench, tmp_path / "track")


@pytest.fixture
def few(request_, tmp_path) -> TrackRequest:
    """Return what is asked of two of the photographs."""
    photos = tmp_path / "few"
    photos.mkdir()
    for number in SOME[:2]:
        shutil.copy(request_.photos / f"simulated_{number}.jpg", photos)
    return replace(request_, photos=photos)


@pytest.fixture(scope="module")
def usual(bench, tmp_path_factory) -> TrackResult:
    """Track the bundled photographs once, with blank pictures, in one process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zebro_lab.track.pictures.save", lambda _, file: file.touch())
        patch.setattr("zebro_lab.track.pictures._MOST_MAP_PIXELS", 1e4)
        return track(asked(bench, tmp_path_factory.mktemp("usual") / "track"), Nobody(), workers=1)


@pytest.fixture
def undrawn(monkeypatch):
    """Leave out the pictures, which take longer than the tracking of so few photographs."""
    for name in ("draw_track", "draw_preview"):
        monkeypatch.setattr(f"zebro_lab.track.pictures.{name}", lambda *_, **__: None)
