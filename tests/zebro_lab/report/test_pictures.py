# SPDX-License-Identifier: MIT
"""Pictures are embedded small and true, and none from outside of a folder."""

import base64
import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from support.report_pages import made
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.report import pictures
from zebro_lab.report.pictures import CAPTIONS, embed, lies_in


def unpacked(url: str) -> Image.Image:
    """Return the picture in a `data:` URL of WebP."""
    start, _, data = url.partition(",")
    assert start == "data:image/webp;base64"
    return Image.open(io.BytesIO(base64.b64decode(data)))


def drawn(file, pixels) -> Path:
    Image.fromarray(pixels).save(file)
    return file


def lines() -> np.ndarray:
    """Return few colours with sharp edges, as a plot has."""
    pixels = np.full((300, 400, 3), 255, np.uint8)
    pixels[::25] = (31, 119, 180)
    pixels[:, ::40] = 0
    return pixels


def grain() -> np.ndarray:
    """Return soft shades with noise, as a photograph has."""
    rng = np.random.default_rng(1)
    shade = 100 + 50 * np.sin(np.arange(400) / 60) + np.zeros((300, 400))
    noisy = shade[..., None] + rng.normal(0, 4, (300, 400, 3))
    return noisy.clip(0, 255).astype(np.uint8)


def test_every_picture_is_embedded_and_described(walk):
    page = made(walk)
    assert len(page.all("img")) == len(list(walk.parent.rglob("*.png")))
    assert all(unpacked(img["src"]).size == (4, 4) for img in page.all("img"))
    assert all(len(img["alt"]) > 20 and "simulated" in img["alt"] for img in page.all("img"))


def test_lines_are_embedded_exactly(tmp_path):
    found = embed(drawn(tmp_path / "gantt.png", lines()), stage="prediction", simulated=False)
    np.testing.assert_array_equal(np.asarray(unpacked(found.data).convert("RGB")), lines())


def test_photographs_are_embedded_small_and_look_the_same(tmp_path):
    file = drawn(tmp_path / "map.png", grain())
    url = embed(file, stage="track", simulated=False).data
    away = np.asarray(unpacked(url).convert("RGB")).astype(float) - grain()
    assert np.sqrt(np.mean(away**2)) < 6
    assert len(url) < file.stat().st_size / 4


def test_an_svg_is_embedded_as_it_is(tmp_path):
    svg = b'<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg"/>'
    (tmp_path / "path.svg").write_bytes(svg)
    found = embed(tmp_path / "path.svg", stage="prediction", simulated=False)
    start, _, data = found.data.partition(",")
    assert (start, base64.b64decode(data)) == ("data:image/svg+xml;base64", svg)
    assert found.caption == CAPTIONS["path"]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.png", b"GIF89a", "is not a PNG; delete it and run again"),
        ("a.png", b"\x89PNG\r\n\x1a\nrest", "is a damaged PNG; delete it and run again"),
        ("a.svg", b"<html>", "is not an SVG; delete it and run again"),
    ],
)
def test_what_is_no_picture_is_refused(name, content, message, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(DataError, match=message):
        embed(tmp_path / name, stage="track", simulated=True)
    with pytest.raises(NotFound):
        embed(tmp_path / f"b{name}", stage="track", simulated=True)


def test_a_picture_cut_short_or_too_large_is_refused(tmp_path, monkeypatch):
    file = drawn(tmp_path / "map.png", grain())
    monkeypatch.setattr(pictures, "_MOST_PIXELS", 1000)
    with pytest.raises(DataError, match=r"has 400 × 300 pixels; expected at most"):
        embed(file, stage="track", simulated=True)
    monkeypatch.undo()
    file.write_bytes(file.read_bytes()[:5000])
    with pytest.raises(DataError, match=r"cannot be read as PNG .*; delete it and run again"):
        embed(file, stage="track", simulated=True)


@pytest.mark.parametrize("name", ["../secret.png", "/etc/x.png", "a/../b.png", "link.png", "a\0b"])
def test_files_outside_the_folder_do_not_lie_in_it(tmp_path, name):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "link.png").symlink_to(tmp_path / "secret.png")
    assert not lies_in(tmp_path / "in", name)
    assert lies_in(tmp_path / "in", "a.png")
