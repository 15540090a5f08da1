# SPDX-License-Identifier: MIT
"""Reports: whole in themselves, escaped, and with the numbers of the files they are from."""

import pytest

from support.report_pages import made
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound


def test_the_page_needs_no_other_file_and_no_network(walk):
    page = made(walk)
    assert not page.all("script")
    assert not page.all("link")
    addresses = [
        attrs[key] for _, attrs in page.tags for key in ("src", "href", "srcset") if key in attrs
    ]
    assert addresses
    assert all(each.startswith(("data:image/webp;base64,", "#")) for each in addresses)
    style = (walk.parent / "report.html").read_text().split("</style>")[0]
    assert "url(" not in style
    assert "@import" not in style


def test_bad_input_leaves_no_page(walk, tmp_path):
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(NotFound, match=r"run\.json"):
        made(empty, out=tmp_path / "r.html")
    (walk / "track/manifest.json").write_text("{")
    with pytest.raises(DataError, match="restore or create the file again"):
        made(walk, out=tmp_path / "r.html")
    with pytest.raises(AlreadyExists, match="is a folder"):
        made(walk, out=empty)
    with pytest.raises(NotFound, match="--out"):
        made(walk, out=tmp_path / "no" / "r.html")
    assert not (tmp_path / "r.html").exists()
