# SPDX-License-Identifier: MIT
"""The robot in 3-D stands where the path has it, on the ground that it walked."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from model.robot import Robot
from model.walk.ground import FLAT, ground_at, with_slope
from zebro_lab.plots.sheet import RED
from zebro_lab.plots.walk_scene import WalkScene, ground_lines, heights_along, snapshots

HILL = with_slope(FLAT, 0.2, -0.1)
LOW, HIGH = np.array([-0.2, 0.0]), np.array([0.3, 0.4])


@pytest.mark.parametrize("ground", [FLAT, HILL])
def test_lines_lie_on_the_ground_and_within_the_view(ground):
    lines = ground_lines(ground, LOW, HIGH)
    assert len(lines) == 10 + 8
    for x, y, z in np.concatenate(lines):
        assert z == pytest.approx(ground_at(ground, x, y)[0])
        assert -0.2 <= x <= 0.3 + 1e-9
        assert 0.0 <= y <= 0.4 + 1e-9


def test_places_have_the_height_of_the_ground():
    (found,) = heights_along(HILL, np.array([[0.5, 1.0]]))
    np.testing.assert_allclose(found, [0.5, 1.0, 0.5 * np.tan(0.2) - np.tan(0.1)])


@pytest.mark.parametrize("sample", [0, 60])
def test_body_legs_and_trace_are_those_of_the_sample(walked, sample):
    axes = Figure().add_subplot(projection="3d")
    WalkScene(axes, walked, Robot()).show(sample)
    trace, head = (np.array(line.get_data_3d()).T for line in axes.lines)
    position = walked.position[sample]
    np.testing.assert_allclose(trace[-1, :2], position[:2])
    assert len(trace) == sample + 1
    assert np.abs(head.mean(axis=0) - position).max() < Robot().body_size[0]
    assert np.mean(axes.get_xlim()) == pytest.approx(position[0])
    legs = np.concatenate([each.get_colors() for each in axes.collections[1:4:2]])
    on_ground = np.all(legs == to_rgba(RED), axis=1)
    assert (len(legs), on_ground.sum()) == (6, walked.contact[sample].sum())


def test_each_snapshot_names_its_time_and_the_legs_on_the_ground(walked):
    at = (0.5, 1.0, 1.5, 1.9)
    figure = snapshots(walked, Robot(), title="A walk", at=at)
    assert figure.get_suptitle() == "A walk (simulated)"
    texts = [axes.get_title() for axes in figure.axes]
    for t, text in zip(at, texts, strict=True):
        legs = walked.contact[abs(walked.t - t).argmin()].nonzero()[0] + 1
        assert text == f"t = {t:g} s   {{{', '.join(map(str, legs))}}}"
