# SPDX-License-Identifier: MIT
"""Whatever is wrong with photographs, maps and videos is one line that names them."""

import json
import re
import shutil
import sys
from pathlib import Path

import cv2
import numpy as np
import PIL.Image
import pytest

from zebro_lab.main import app
from zebro_lab.terminal.ending import run as run_app

pytestmark = pytest.mark.usefixtures("blank_pictures")

WALK = Path(__file__).parents[3] / "datasets/walk-sim"
SIZE = (800, 600)
GOOD = ("simulated_00.jpg", "simulated_02.jpg", "simulated_03.jpg")
HEIC = b"\0\0\0\x18ftypheic\0\0\0\0mif1heic"


@pytest.fixture(scope="module")
def small(tmp_path_factory) -> Path:
    """Return a folder of three of the bundled photographs at half their size."""
    folder = tmp_path_factory.mktemp("small")
    for name in GOOD:
        with PIL.Image.open(WALK / "photos" / name) as picture:
            picture.resize(SIZE).save(folder / name, exif=picture.getexif(), quality=95)
    return folder


@pytest.fixture
def lab(small, tmp_path, monkeypatch) -> Path:
    """Return a folder to work in, with `photos/`, camera.toml, floor.toml and robot.toml."""
    shutil.copytree(small, tmp_path / "photos")
    for name in ("camera.toml", "floor.toml", "robot.toml"):
        shutil.copy(WALK / name, tmp_path)
    monkeypatch.setattr("zebro_lab.track.pictures.draw_track", lambda *_, **__: None)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def track(monkeypatch, capfd):
    """Return a runner of `track` in this process: exit code, stdout, stderr."""

    def runner(photos: object, *options: object) -> tuple[int, str, str]:
        files = ("--camera", "camera.toml", "--floor", "floor.toml", "--robot", "robot.toml")
        arguments = ("track", photos, *files, "--out", "out", *options)
        monkeypatch.setattr(sys, "argv", ["zebro-lab", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            run_app(app)
        streams = capfd.readouterr()
        return int(ended.value.code or 0), streams.out, streams.err

    return runner


def redraw(photo: Path, change) -> None:
    """Change the pixels of a photograph and keep its time."""
    with PIL.Image.open(photo) as picture:
        exif, pixels = picture.getexif(), np.array(picture)
    PIL.Image.fromarray(change(pixels)).save(photo, exif=exif, quality=95)


def bare(pixels: np.ndarray) -> np.ndarray:
    return np.full_like(pixels, 120)


def second_robot(pixels: np.ndarray) -> np.ndarray:
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    pixels[240:320, 350:430] = 255
    pixels[255:305, 365:415] = cv2.aruco.generateImageMarker(dictionary, 0, 50)[..., None]
    return pixels


def claim_size(photo: Path, width: int, height: int) -> None:
    """Let a JPEG's header say another size; nothing of that size is ever made."""
    jpeg = bytearray(photo.read_bytes())
    frame = jpeg.index(b"\xff\xc0") + 5
    jpeg[frame : frame + 4] = height.to_bytes(2) + width.to_bytes(2)
    photo.write_bytes(jpeg)


def spoil(photos: Path, fault: str, name: str) -> None:
    """Put a photograph with a fault beside the others."""
    photo = photos / name
    photo.write_bytes((photos / GOOD[1]).read_bytes())
    if fault == "no floor":
        redraw(photo, bare)
    elif fault == "two robots":
        redraw(photo, second_robot)
    elif fault == "another size":
        redraw(photo, lambda pixels: pixels[:300, :400])
    elif fault == "no time":
        PIL.Image.new("RGB", SIZE).save(photo)
    elif fault == "cut short":
        photo.write_bytes(photo.read_bytes()[:20_000])
    elif fault == "heic":
        photo.write_bytes(HEIC)
    elif fault == "200 MP":
        claim_size(photo, 20_000, 10_000)
    elif fault == "126 MP":
        claim_size(photo, 14_000, 9_000)
    else:
        photo.write_text("" if fault == "empty" else "no picture")


BAD = {
    "p1.jpg": ("no floor", "none of the floor's markers (10, 11, 12, 13 of '4x4_50') is seen"),
    "p2.jpg": ("two robots", "the robot's marker 0 is seen 2 times"),
    "p3.jpg": ("another size", "400x300 px; expected 800x600 px"),
    "p4.jpg": ("no time", "no EXIF time"),
    "p5.jpg": ("cut short", "the file is cut short or damaged"),
    "p6.HEIC": ("heic", "HEIC is not read; set the phone's camera to 'most compatible'"),
    "p7.jpg": ("heic", "heif-convert -q 95 p7.jpg p7.jpeg"),
    "p8.jpg": ("200 MP", "more than 179 megapixels; at most 80 are read"),
    "p9.jpg": ("126 MP", "14000x9000 px are 126 megapixels; at most 80 are read"),
    "q1.jpg": ("empty", "the file is empty (0 bytes)"),
    "q2.png": ("text", "not a readable picture; expected JPEG, PNG or TIFF"),
}


def test_bad_photographs_are_named_with_their_fault_and_lose_no_other(lab, track):
    for name, (fault, _) in BAD.items():
        spoil(lab / "photos", fault, name)
    code, out, err = track("photos")
    assert (code, err) == (0, "")
    assert f"3 of {3 + len(BAD)} photographs" in out
    left_out = json.loads(Path("out/manifest.json").read_text())["left_out"]
    assert set(left_out) == set(BAD)
    for name, (_, reason) in BAD.items():
        assert reason in left_out[name]


@pytest.mark.parametrize("fault", ["no floor", "two robots", "heic", "200 MP", "empty"])
def test_where_no_photograph_can_be_used_the_first_is_named(fault, lab, track):
    for name in GOOD[1:]:
        spoil(lab / "photos", fault, name)
    (lab / "photos" / GOOD[0]).unlink()
    reason = next(reason for found, reason in BAD.values() if found == fault)
    reason = reason.replace("p7", "simulated_02")
    count = 1 if fault == "no floor" else 2  # both are one grey picture: the copy is left out
    found = f"none of {count} photographs can be used; simulated_02.jpg: {reason}"
    assert_refused(track("photos"), found)


def assert_refused(ended: tuple[int, str, str], message: str) -> None:
    code, out, err = ended
    assert (code, out) == (1, "")
    assert err.startswith("error: ")
    assert message in err
    assert err.count("\n") == 1
    assert not Path("out").exists()


def edit(file: str, pattern: str, replacement) -> None:
    path = Path(file)
    path.write_text(re.sub(pattern, replacement, path.read_text()))


def test_a_marker_that_is_the_robots_and_the_floors_is_refused(lab, track):
    edit("robot.toml", "id = 0", "id = 12")
    assert_refused(track("photos"), "marker 12 is listed both for the robot and")
