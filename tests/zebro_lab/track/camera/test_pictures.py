# SPDX-License-Identifier: MIT
"""A page is drawn at true scale: a millimetre of it is a millimetre on paper."""

import numpy as np
import pytest

from zebro_lab.track.camera.kit import KitPage, Rectangle, Text
from zebro_lab.track.camera.pictures import draw_page, save_pages

PAGE = KitPage(210.0, 297.0, (Rectangle(10.0, 20.0, 100.0, 3.0),), (Text(30.0, 50.0, "100 mm", 9),))


def test_a_rectangle_has_its_size_on_the_paper():
    figure = draw_page(PAGE)
    assert figure.get_size_inches() == pytest.approx([210 / 25.4, 297 / 25.4])
    (patch,) = figure.axes[0].patches
    inches = patch.get_window_extent().bounds / np.array(figure.dpi)
    np.testing.assert_allclose(25.4 * inches, [10, 20, 100, 3], rtol=1e-9)
    assert [text.get_text() for text in figure.axes[0].texts] == ["100 mm"]


def test_the_same_pages_are_the_same_bytes(tmp_path):
    for name in ("a.pdf", "b.pdf"):
        save_pages([PAGE, PAGE], tmp_path / name)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
