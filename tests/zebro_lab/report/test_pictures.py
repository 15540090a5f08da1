# SPDX-License-Identifier: MIT
"""Pictures are embedded as they are, and none from outside of a folder."""

import base64

import pytest

from support.report_pages import made
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.report.pictures import CAPTIONS, caption_of, embed, lies_in, place_of


def test_every_picture_is_embedded_as_it_is_and_described(walk):
    page = made(walk)
    shown = [base64.b64decode(img["src"].partition(",")[2]) for img in page.all("img")]
    expected = [file.read_bytes() for file in walk.parent.rglob("*.png")]
    assert sorted(shown) == sorted(expected)
    assert all(len(img["alt"]) > 20 and "simulated" in img["alt"] for img in page.all("img"))


PNG = b"\x89PNG\r\n\x1a\nrest"


def test_a_picture_is_a_data_url_with_caption_and_name(tmp_path):
    (tmp_path / "curves.png").write_bytes(PNG)
    found = embed(tmp_path / "curves.png", stage="calibration", simulated=False)
    start, _, data = found.data.partition(",")
    assert (start, base64.b64decode(data)) == ("data:image/png;base64", PNG)
    assert (found.caption, found.name) == (CAPTIONS["curves"], "curves.png")
    simulated = embed(tmp_path / "curves.png", stage="calibration", simulated=True)
    assert simulated.caption == CAPTIONS["curves"] + " (simulated)"


def test_what_is_no_picture_is_refused(tmp_path):
    (tmp_path / "a.png").write_bytes(b"GIF89a")
    with pytest.raises(DataError, match="is not a PNG; delete it and run again"):
        embed(tmp_path / "a.png", stage="track", simulated=True)
    with pytest.raises(NotFound):
        embed(tmp_path / "b.png", stage="track", simulated=True)


@pytest.mark.parametrize("name", ["../secret.png", "/etc/x.png", "a/../b.png", "link.png", "a\0b"])
def test_files_outside_the_folder_do_not_lie_in_it(tmp_path, name):
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "link.png").symlink_to(tmp_path / "secret.png")
    assert not lies_in(tmp_path / "in", name)
    assert lies_in(tmp_path / "in", "a.png")


def test_captions_go_by_name_and_in_a_validation_by_its_end():
    assert caption_of("map", stage="track") == CAPTIONS["map"]
    assert caption_of("walk.floor", stage="validation") == CAPTIONS[".floor"]
    assert caption_of("map", stage="validation") == CAPTIONS[".errors"]
    assert caption_of("my_own-one", stage="track") == "my own one"
    names = ["other.png", "band.png", "path.png", "map.png"]
    assert sorted(names, key=place_of) == ["map.png", "path.png", "band.png", "other.png"]
