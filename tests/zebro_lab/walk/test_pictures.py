# SPDX-License-Identifier: MIT
"""A walk folder has every picture, in the format and of the time that were asked for."""

import numpy as np
import pytest
from PIL import Image

from model.robot import Robot
from support.drawn_figures import figures_saved
from zebro_lab.terminal.picture_options import Instants, Window
from zebro_lab.walk.folder import FILES, PICTURES
from zebro_lab.walk.output_request import PictureRequest
from zebro_lab.walk.pictures import draw_walk


def test_folder_gets_every_picture(walked, tmp_path):
    draw_walk(tmp_path, walked, Robot(), title="tripod, dynamics", asked=PictureRequest())
    assert {p.name for p in tmp_path.iterdir()} == {f"{name}.png" for name in PICTURES}
    for path in tmp_path.iterdir():
        with Image.open(path) as image:
            assert np.asarray(image.convert("L")).std() > 5  # something is drawn


def test_pictures_have_the_format_asked_for_and_belong_to_the_folder(walked, tmp_path, monkeypatch):
    figures = figures_saved(monkeypatch)
    draw_walk(tmp_path, walked, Robot(), title="t", asked=PictureRequest(True, form="svg"))
    assert set(figures) == {f"{name}.svg" for name in PICTURES}
    assert set(figures) < set(FILES)


def test_a_window_is_the_time_of_every_figure_over_time(walked, tmp_path, monkeypatch):
    figures = figures_saved(monkeypatch)
    asked = PictureRequest(True, Instants((0.5, 1.5)), Window(1.0, 2.0))
    draw_walk(tmp_path, walked, Robot(), title="t", asked=asked)
    for name in ("motion", "slip_ratio", "gantt"):
        shown = figures[f"{name}.png"].axes[0].get_xlim()
        assert shown == pytest.approx((1.0, 2.0), abs=0.011), name
    path = figures["path.png"]
    labels = [text.get_text() for text in path.legends[0].get_texts()]
    assert labels[:2] == ["t = 0.5 s", "t = 1.5 s"]
    assert len(path.axes[0].patches) == 2
