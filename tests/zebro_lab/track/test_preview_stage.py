# SPDX-License-Identifier: MIT
"""The first photograph alone shows what is found, and checks the tape."""

import re
from dataclasses import replace

import pytest
from PIL import Image

from zebro_lab.track.preview_stage import preview


def test_the_preview_compares_tape_and_photograph(request_, tmp_path):
    file = tmp_path / "preview.png"
    seen = preview(request_, file)
    assert file.read_bytes()[:4] == b"\x89PNG"
    assert seen.marks == ("10", "11", "12", "13")
    assert len(seen.tape) == 6
    assert not any(check.is_off for check in seen.tape)
    assert seen.robot == pytest.approx((0, 0, 0), abs=3e-3)
    assert 1e-3 < seen.scale < 4e-3


def test_photographs_without_times_are_previewed_by_name(request_, tmp_path):
    photos = tmp_path / "photos"
    photos.mkdir()
    for path in sorted(request_.photos.glob("*.jpg"))[:2]:
        Image.open(path).save(photos / path.name, quality=95)  # without EXIF
    seen = preview(replace(request_, photos=photos), tmp_path / "preview.png")
    assert seen.photo == min(path.name for path in photos.iterdir())


def test_a_preview_warns_of_what_a_track_would_warn_of(request_, tmp_path):
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
