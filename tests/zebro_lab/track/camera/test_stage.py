# SPDX-License-Identifier: MIT
"""Photographs of a board become the lens that took them; the kit is written once."""

import shutil
import tomllib
from pathlib import Path

import pytest

from tracking.camera import CharucoBoard, Checkerboard
from tracking.errors import CalibrationError
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.track.camera.request import CameraRequest
from zebro_lab.track.camera.stage import calibrate_camera, parse_board, write_kit
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.floor_file import read_floor_file

WALK = Path(__file__).parents[4] / "datasets/walk-sim"
BOARD = "charuco:9x6:40mm:30mm:4x4_50"


class Nobody:
    """Follows without a word."""

    def step(self, what: str, fraction: float | None) -> None:
        """Hear nothing."""

    def stop_requested(self) -> bool:
        """Never stop."""
        return False


def test_the_lens_of_the_bundled_photographs_is_found_within_its_error(tmp_path):
    photos = tmp_path / "boards"
    shutil.copytree(WALK / "calibration", photos)
    (photos / "cut.jpg").write_bytes((photos / "simulated_board_00.jpg").read_bytes()[:5000])
    shutil.copy(WALK / "photos/simulated_00.jpg", photos / "no_board.jpg")
    result = calibrate_camera(CameraRequest(photos, BOARD, tmp_path / "camera.toml"), Nobody())
    assert set(result.left_out) == {"cut.jpg", "no_board.jpg"}
    camera = read_camera_file(result.file)
    true = tomllib.loads((WALK / "truth.toml").read_text())["camera"]
    assert abs(camera.matrix[0, 0] - true["focal"][0]) < 3 * result.fit.sd[0]
    assert abs(camera.matrix[0, 2] - true["centre"][0]) < 3 * result.fit.sd[2]
    assert camera.distortion[0] == pytest.approx(true["distortion"][0], abs=5e-3)
    kept = tomllib.loads(result.file.read_text())["calibration"]["photos"]
    assert len(kept) == 12


def test_another_board_is_an_error_that_says_so_and_writes_nothing(tmp_path):
    photos = tmp_path / "boards"
    photos.mkdir()
    shutil.copy(WALK / "calibration/simulated_board_00.jpg", photos)
    with pytest.raises(CalibrationError, match="--board"):
        calibrate_camera(CameraRequest(photos, out=tmp_path / "camera.toml"), Nobody())
    assert not (tmp_path / "camera.toml").exists()


@pytest.mark.reference
@pytest.mark.parametrize("counted", ["10x7"])
def test_a_count_that_is_off_by_one_is_recognised(shared, tmp_path, counted):
    photos = tmp_path / "boards"
    photos.mkdir()
    for name in ("left01.jpg", "left02.jpg", "left03.jpg"):
        shutil.copy(shared / "realdata/checkerboards" / name, photos)
    request = CameraRequest(photos, f"checkerboard:{counted}:25mm", tmp_path / "camera.toml")
    with pytest.raises(
        CalibrationError, match=r"3 of the first 3 .* 9x6 inner corners.*checkerboard:9x6:25mm"
    ):
        calibrate_camera(request, Nobody())


def test_the_kit_comes_with_a_floor_to_edit_and_never_over_an_edited_one(tmp_path):
    pdf, floor = write_kit(tmp_path / "kit")
    assert pdf.read_bytes()[:5] == b"%PDF-"
    assert len(read_floor_file(floor).markers) == 4
    with pytest.raises(AlreadyExists, match="measured positions"):
        write_kit(tmp_path / "kit")


@pytest.mark.reference
def test_real_checkerboards_give_the_published_focal_length(shared, tmp_path):
    request = CameraRequest(
        shared / "realdata/checkerboards", "checkerboard:9x6:25mm", tmp_path / "camera.toml"
    )
    result = calibrate_camera(request, Nobody())
    assert result.fit.camera.matrix[0, 0] == pytest.approx(535.9, rel=0.005)
    assert result.fit.rms <= 0.42


@pytest.mark.parametrize(
    "text", ["9x6", "checkerboard:9:25mm", "charuco:7x5:26mm:35mm:4x4_50", "checkerboard:9x6:25",
             "charuco:7x5:35mm:26mm:4x4_51", "kit:a4"],
)  # fmt: skip
def test_what_is_no_board_is_refused(text):
    with pytest.raises(SettingsError, match="--board"):
        parse_board(text)


def test_boards_are_what_their_description_says():
    assert parse_board("checkerboard:9x6:25mm") == Checkerboard(9, 6, 0.025)
    assert parse_board("charuco:7x5:35mm:25mm:5x5_50") == CharucoBoard(7, 5, 0.035, 0.025, "5x5_50")
    assert isinstance(parse_board("kit"), CharucoBoard)
