# SPDX-License-Identifier: MIT
"""The bundled simulated photographs become the track they were taken of, whatever goes wrong."""

import json
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from support.bundled_walk import COMPOSITE, SOME, Nobody, truth
from tracking.body import Alignment
from tracking.composite import Exposure
from tracking.errors import TrackStopped
from tracking.path import TRACK_COLUMNS
from tracking.photos import search
from tracking.pose import BodyPose
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.files.result_folder import MANIFEST
from zebro_lab.track.folder import TRACKED
from zebro_lab.track.request import TimeRequest
from zebro_lab.track.stage import preview, track


def test_a_track_is_the_walk_within_its_own_error_and_says_it_is_simulated(usual):
    table = pd.read_csv(usual.folder / "track.csv")
    true = truth(table["photo"])
    assert tuple(table.columns) == TRACK_COLUMNS
    error = table[["x_m", "y_m", "yaw_rad"]].to_numpy() - true[["x", "y", "yaw"]]
    sd = np.sqrt(table[["cov_xx", "cov_yy", "cov_yawyaw"]].to_numpy())
    assert np.abs(error[["x", "y"]]).max(axis=None) < 8e-3
    assert np.degrees(np.abs(error["yaw"]).max()) < 0.1
    assert (np.abs(error) / sd).max(axis=None) < 3
    np.testing.assert_allclose(np.diff(table["t_s"]), np.diff(true["t"]), atol=2e-3)
    manifest = json.loads((usual.folder / "manifest.json").read_text())
    assert (manifest["kind"], manifest["source"]) == ("track", "sim:photographs")
    names = {name for name in TRACKED.names if not name.endswith((".svg", ".pdf"))}
    assert {path.name for path in usual.folder.iterdir()} == {*names, MANIFEST} - {
        "annotations.toml"
    }
    assert len((usual.folder / "track.tum").read_text().splitlines()) == len(SOME)


def test_a_second_track_replaces_the_first_and_another_commands_result_is_safe(few, undrawn):
    track(few, Nobody())
    (few.folder / "notes.txt").write_text("mine")
    track(few, Nobody())
    assert (few.folder / "notes.txt").read_text() == "mine"
    (few.folder / "manifest.json").write_text('{"kind": "walk", "schema": 1}')
    with pytest.raises(AlreadyExists, match="another command"):
        track(few, Nobody())


def test_a_mean_height_known_better_makes_all_poses_surer_and_keeps_the_bounce(
    usual, request_, undrawn
):
    known = track(replace(request_, mean_height_sd="0.2mm"), Nobody())
    covariances = [each.tracked.track.covariance[:, :2, :2] for each in (usual, known)]
    # The mean height is half of the variance of place here.
    deviations = [np.sqrt(np.trace(each, axis1=1, axis2=2)) for each in covariances]
    assert (deviations[1] < 0.8 * deviations[0]).all()
    settings = json.loads((known.folder / "manifest.json").read_text())["settings"]
    assert (settings["mean_height_sd"], settings["height_sd"]) == (2e-4, 5e-3)


@pytest.mark.long
def test_several_processes_find_what_one_finds(usual, request_, monkeypatch, undrawn):
    monkeypatch.setattr(search, "WORTH_WORKERS", 0.0)
    two = track(request_, Nobody(), workers=2)
    # Not to the last digit: a stretch begins by looking at the whole photograph.
    difference = usual.tracked.track.poses - two.tracked.track.poses
    assert np.abs(difference).max() < 1e-4


def walk_of_the_composite() -> pd.DataFrame:
    return truth(f"simulated_{number:02d}.jpg" for number in range(1, 14, 2))


@pytest.mark.long
def test_exposures_of_a_composite_picture_are_found(request_, undrawn):
    asked = replace(request_, photos=COMPOSITE, times=TimeRequest(4.0))
    result = track(asked, Nobody())
    assert result.source == "sim:photographs"
    true = walk_of_the_composite()
    poses = result.tracked.track.poses
    assert len(poses) == len(true)
    assert np.abs(poses[:, :2] - true[["x", "y"]]).max(axis=None) < 0.012
    assert np.degrees(np.abs(poses[:, 2] - true["yaw"]).max()) < 0.5


@pytest.fixture
def exposures(monkeypatch) -> pd.DataFrame:
    """Let the composite's exposures be found where they are, in no order; return the walk."""
    true = walk_of_the_composite()
    poses = [
        BodyPose(np.array([x, y, 0.06, 0, 0, yaw]), 1e-6 * np.eye(6))
        for x, y, yaw in true[["x", "y", "yaw"]].to_numpy()
    ]
    shuffled = np.random.default_rng(0).permutation(len(poses))
    found = tuple(Exposure(Alignment(poses[k], 0.9, 0.0), 1.0) for k in shuffled)
    monkeypatch.setattr("tracking.photos.exposures.find_exposures", lambda *_, **__: found)
    return true


def test_exposures_of_a_composite_picture_come_in_order(request_, undrawn, exposures):
    asked = replace(request_, photos=COMPOSITE, times=TimeRequest(4.0))
    result = track(asked, Nobody())
    observations = result.tracked.track.observations
    assert [seen.photo for seen in observations] == [
        f"simulated_pasted.jpg#{number}" for number in range(1, len(exposures) + 1)
    ]
    planar = [seen.planar for seen in observations]
    np.testing.assert_allclose(planar, exposures[["x", "y", "yaw"]], atol=1e-9)
    np.testing.assert_allclose(np.diff([seen.t for seen in observations]), 4.0)


def test_a_stop_leaves_nothing(request_):
    with pytest.raises(TrackStopped):
        track(request_, Nobody(stops=True))
    assert not request_.folder.exists()


def test_the_preview_compares_tape_and_photograph(request_, tmp_path):
    file = tmp_path / "preview.png"
    seen = preview(request_, file)
    assert file.read_bytes()[:4] == b"\x89PNG"
    assert seen.marks == ("10", "11", "12", "13")
    assert len(seen.tape) == 6
    assert not any(check.is_off for check in seen.tape)
    assert seen.robot == pytest.approx((0, 0, 0), abs=3e-3)
    assert 1e-3 < seen.scale < 4e-3


def test_photographs_without_times_are_previewed_by_name(request_, tmp_path, undrawn):
    photos = tmp_path / "photos"
    photos.mkdir()
    for path in sorted(request_.photos.glob("*.jpg"))[:2]:
        Image.open(path).save(photos / path.name, quality=95)  # without EXIF
    seen = preview(replace(request_, photos=photos), tmp_path / "preview.png")
    assert seen.photo == min(path.name for path in photos.iterdir())


def test_a_preview_warns_of_what_a_track_would_warn_of(request_, tmp_path, undrawn):
    lens = tmp_path / "camera.toml"
    lens.write_text(request_.camera.read_text().split("[calibration]")[0])
    floor = tmp_path / "floor.toml"
    text = request_.floor.read_text()
    x = re.search(r"11 = \{.*?x = ([-\d.]+)", text)
    assert x is not None
    moved = float(x.group(1)) + 0.03
    floor.write_text(text[: x.start(1)] + f"{moved}" + text[x.end(1) :])
    seen = preview(replace(request_, camera=lens, floor=floor), tmp_path / "preview.png")
    assert any("lens is taken as exact" in each for each in seen.warnings)
    assert any("place of mark 11" in each for each in seen.warnings)
