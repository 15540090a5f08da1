# SPDX-License-Identifier: MIT
"""The robot in 3-D stands where the path has it, on the ground that it walked."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from model.robot import Robot
from zebro_lab.plots.sheet import RED
from zebro_lab.plots.walk_scene import WalkScene


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
