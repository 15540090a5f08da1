# SPDX-License-Identifier: MIT
"""A walk folder has every picture, in the format and of the time that were asked for."""

import pytest

from model.gait.reference import SampledReference
from support.drawn_figures import figures_saved
from zebro_lab.robot.robot_file import RobotFile
from zebro_lab.terminal.picture_options import Instants, Window
from zebro_lab.walk.folder import FILES, PICTURES
from zebro_lab.walk.pictures import draw_walk
from zebro_lab.walk.request import PictureRequest
from zebro_lab.walk.walking import Walked


@pytest.fixture
def finished(walked) -> Walked:
    angles = SampledReference(walked.t, walked.theta)
    return Walked(walked, angles, RobotFile(), None, "dynamics", 0.01, "a log", ())


def test_a_window_is_the_time_of_every_figure_over_time(finished, tmp_path, monkeypatch):
    figures = figures_saved(monkeypatch)
    request = PictureRequest(True, Instants((0.5, 1.5)), Window(1.0, 2.0), form="svg")
    draw_walk(tmp_path, finished, request)
    assert set(figures) == {f"{name}.svg" for name in PICTURES} < set(FILES)
    for name, figure in figures.items():
        assert all(axes.has_data() for axes in figure.axes), name
    for name in ("motion", "slip_ratio", "gantt"):
        shown = figures[f"{name}.svg"].axes[0].get_xlim()
        assert shown == pytest.approx((1.0, 2.0), abs=0.011), name
    path = figures["path.svg"]
    labels = [text.get_text() for text in path.legends[0].get_texts()]
    assert labels[:2] == ["t = 0.5 s", "t = 1.5 s"]
    assert len(path.axes[0].patches) == 2
